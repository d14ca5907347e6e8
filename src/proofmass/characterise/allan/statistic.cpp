#include "proofmass/characterise/allan/statistic.hpp"

#include <algorithm>
#include <array>

namespace proofmass::characterise {
namespace {

struct Entry {
  Statistic statistic;
  std::string_view name, title;
};

constexpr std::array entries{
    Entry{Statistic::adev, "adev", "Allan deviation"},
    Entry{Statistic::oadev, "oadev", "overlapping Allan deviation"},
    Entry{Statistic::mdev, "mdev", "modified Allan deviation"},
    Entry{Statistic::tdev, "tdev", "time deviation"},
    Entry{Statistic::hdev, "hdev", "Hadamard deviation"},
    Entry{Statistic::ohdev, "ohdev", "overlapping Hadamard deviation"},
    Entry{Statistic::totdev, "totdev", "total deviation"},
    Entry{Statistic::mtotdev, "mtotdev", "modified total deviation"},
    Entry{Statistic::ttotdev, "ttotdev", "time total deviation"},
    Entry{Statistic::htotdev, "htotdev", "Hadamard total deviation"},
    Entry{Statistic::theo1, "theo1", "Theo1 deviation"},
    Entry{Statistic::pdev, "pdev", "parabolic deviation"},
};

}  // namespace

std::string_view name_of(Statistic statistic) {
  return entries[static_cast<std::size_t>(statistic)].name;
}

std::string_view title_of(Statistic statistic) {
  return entries[static_cast<std::size_t>(statistic)].title;
}

std::optional<Statistic> parse_statistic(std::string_view name) {
  const auto* found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
  return found == entries.end() ? std::nullopt : std::optional(found->statistic);
}

}  // namespace proofmass::characterise
