#include "proofmass/thesis/wording.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/comparison.hpp"

namespace proofmass::thesis {
namespace {

struct Told {
  std::string_view id, key, label;
};

constexpr std::array<Told, 4> told{{
    {"figure 5.17", "integrated", "Off after a turn: double integration"},
    {"figure 5.17", "thesis", "thesis's filter, smoothed"},
    {"figure 5.17", "wheel_smoothed", "wheel model, smoothed"},
    {"figure 5.17", "wheel_datasheet", "with all of the datasheet's errors"},
}};

}  // namespace

std::string thesis_conclusion(const std::vector<Item>& items) {
  const Agreement all = agreement(items);
  const std::size_t lost = all.printed - all.compared;
  return fmt::format(
      "{} tables, figures and sections of the thesis, computed anew. They print {}: {} agree with "
      "ours, {} do not{}.",
      items.size(), report::count_words(all.printed, "number"), all.agreeing,
      all.compared - all.agreeing, lost > 0 ? fmt::format(", {} cannot be told again", lost) : "");
}

std::vector<Headline> headlines(const std::vector<Item>& items) {
  std::vector<Headline> out;
  for (const auto& [id, key, label] : told) {
    const auto item = std::ranges::find(items, id, &Item::id);
    if (item == items.end()) continue;
    const auto finding = std::ranges::find(item->findings, key, &Finding::key);
    if (finding == item->findings.end() || !finding->ours) continue;
    out.push_back({std::string(label), ours_words(*finding)});
  }
  return out;
}

std::string heading(const Item& item) {
  std::string text = item.id + ". " + item.title;
  if (!text.empty())
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string simulated_words(const ThesisReport& report) {
  std::string names;
  for (const std::string& one : report.programme.simulated)
    names += (names.empty() ? "" : ", ") + one;
  if (names.empty()) return {};
  return fmt::format("Simulated on the thesis's rig, seed {}, {} at each speed: {}.", report.seed,
                     report::count_words(report.runs, "run"), names);
}

}  // namespace proofmass::thesis
