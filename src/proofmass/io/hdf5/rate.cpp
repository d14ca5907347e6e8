#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>

#include "proofmass/io/hdf5/labels.hpp"
#include "proofmass/io/hdf5/path.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::hdf5 {
namespace {

/// The rate given by a number of that name.
std::optional<double> rate_said(std::string_view name, std::optional<double> figure) {
  constexpr std::array<std::string_view, 7> steps{"dt",
                                                  "dts",
                                                  "sampleperiod",
                                                  "samplingperiod",
                                                  "sampleinterval",
                                                  "wfincrement",
                                                  "samplinginterval"};
  if (!figure) return std::nullopt;
  if (matlab::is_rate_name(name)) return *figure;
  return is_one_of(name, steps) && *figure > 0.0 ? std::optional(1.0 / *figure) : std::nullopt;
}

/// A number stored as text: "285.7 Hz".
std::optional<double> figure_of(const Attribute& attribute) {
  if (attribute.figure || attribute.texts.size() != 1) return attribute.figure;
  const std::string& text = attribute.texts[0];
  double figure = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), figure);
  const std::string rest = bare_name({stop, text.data() + text.size()});
  if (error != std::errc() || !(rest.empty() || rest == "hz" || rest == "s")) return std::nullopt;
  return figure;
}

struct SaidRate {
  double rate_hz = 0.0;
  std::string what;  ///< where it is given
};

/// From the attributes of a dataset or group, or the scalars in it.
std::optional<SaidRate> rate_of_owner(const Catalogue& catalogue, std::string_view owner) {
  for (const Attribute& attribute : catalogue.attributes)
    if (attribute.owner == owner)
      if (const auto rate_hz = rate_said(attribute.name, figure_of(attribute)))
        return SaidRate{*rate_hz, "attribute " + attribute.name};
  for (const Dataset& dataset : catalogue.datasets)
    if (std::string_view(dataset.path).substr(0, dataset.group_length) == owner)
      if (const auto rate_hz = rate_said(leaf_of(dataset.path), dataset.figure))
        return SaidRate{*rate_hz, dataset.path};
  return std::nullopt;
}

}  // namespace

std::optional<double> rate_hz_of(const Catalogue& catalogue,
                                 const std::vector<matlab::Table>& tables,
                                 std::vector<Note>& notes) {
  std::optional<SaidRate> said;
  std::string_view owner = tables.front().array->path;
  while (!(said = rate_of_owner(catalogue, owner)) && !owner.empty()) owner = group_of(owner);
  if (!said) return std::nullopt;
  const bool can_be = matlab::is_rate(said->rate_hz);
  notes.push_back({Severity::info,
                   can_be ? fmt::format("{}: the rate, {} Hz", said->what, in_words(said->rate_hz))
                          : said->what + ": is not a possible rate"});
  return can_be ? std::optional(said->rate_hz) : std::nullopt;
}

void note_texts(const Catalogue& catalogue,
                const std::vector<matlab::Table>& tables,
                std::vector<Note>& notes) {
  constexpr std::size_t most_texts = 4;
  constexpr std::size_t longest = 160;
  constexpr std::array<std::string_view, 6> factors{"scale",     "scalefactor", "gain",
                                                    "addoffset", "offset",      "sensitivity"};
  std::size_t texts = 0;
  for (const Attribute& attribute : catalogue.attributes) {
    if (attribute.owner.empty() && attribute.texts.size() == 1 && texts < most_texts) {
      const std::string& text = attribute.texts[0];
      std::size_t end = std::min(text.size(), longest);
      while (end < text.size() && (text[end] & 0xC0) == 0x80) --end;  // not within a character
      notes.push_back({Severity::info, fmt::format("{}: {}{}", attribute.name, text.substr(0, end),
                                                   end < text.size() ? "…" : "")});
      ++texts;
    }
    const bool is_read = std::ranges::any_of(
        tables, [&](const matlab::Table& table) { return table.array->path == attribute.owner; });
    if (is_read && attribute.figure && is_one_of(attribute.name, factors))
      notes.push_back(
          {Severity::warning,
           fmt::format("{}: its attribute {} = {} is not applied: the values are as stored",
                       attribute.owner, attribute.name, in_words(*attribute.figure))});
  }
}

}  // namespace proofmass::io::hdf5
