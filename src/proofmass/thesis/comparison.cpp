#include "proofmass/thesis/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/wording.hpp"

namespace proofmass::thesis {
namespace {

constexpr int digits_shown = 5;

std::string with_unit(const std::string& figure, const std::string& unit) {
  return figure + (unit.empty() || unit == "°" ? "" : " ") + unit;
}

double off(const Finding& finding) {
  return finding.ours->value - *finding.thesis;
}

bool is_alike(const Finding& finding) {
  // What was computed alike may differ by the rounding of a unit.
  constexpr double rounding = 1e-9;
  return std::abs(off(finding)) <= (alike + rounding) * std::abs(*finding.thesis);
}

bool is_consistent(const Finding& finding) {
  return std::abs(off(finding)) <= alike_std * finding.ours->std;
}

void add(const Agreement& more, Agreement& all) {
  all.printed += more.printed;
  all.compared += more.compared;
  all.agreeing += more.agreeing;
}

std::string ratio_words(const Finding& finding) {
  const double printed = *finding.thesis, ours = finding.ours->value;
  if (printed == ours) return "the same";
  if (printed == 0.0 || ours == 0.0) {
    const double shown = off(finding) / finding.shown.to_si;
    return with_unit((shown > 0.0 ? "+" : "") + report::significant(shown, 2),
                     finding.shown.symbol);
  }
  const double ratio = ours / printed;
  constexpr double least_shown = 5e-4, most_percent = 2.0, few_percent = 0.1;
  if (ratio < 0.0) return "other sign";
  if (std::abs(ratio - 1.0) < least_shown) return "the same";
  if (ratio >= most_percent) return "× " + report::significant(ratio, 2);
  if (ratio <= 1.0 / most_percent) return "1/" + report::significant(1.0 / ratio, 2);
  const int decimals = std::abs(ratio - 1.0) < few_percent ? 1 : 0;
  return (ratio > 1.0 ? "+" : "") + report::fixed(100.0 * (ratio - 1.0), decimals) + " %";
}

}  // namespace

bool is_compared(const Finding& finding) {
  return finding.thesis && finding.ours;
}

bool agrees(const Finding& finding) {
  return is_compared(finding) && (is_alike(finding) || is_consistent(finding));
}

Agreement agreement(const Item& item) {
  Agreement out;
  for (const Finding& finding : item.findings) {
    out.printed += finding.thesis ? 1 : 0;
    out.compared += is_compared(finding) ? 1 : 0;
    out.agreeing += agrees(finding) ? 1 : 0;
  }
  return out;
}

Agreement agreement(const std::vector<Item>& items) {
  Agreement out;
  for (const Item& item : items) add(agreement(item), out);
  return out;
}

std::string agreement_words(const Agreement& agreement) {
  if (agreement.printed == 0) return {};
  if (agreement.compared == 0) return "not determined";
  return fmt::format("{} of {} agree", agreement.agreeing, agreement.compared);
}

std::string thesis_words(const Finding& finding) {
  if (!finding.thesis) return {};
  return with_unit(report::compact(*finding.thesis / finding.shown.to_si, digits_shown),
                   finding.shown.symbol);
}

std::string ours_words(const Finding& finding) {
  if (!finding.ours) return {};
  const double factor = 1.0 / finding.shown.to_si;
  const Uncertain ours{finding.ours->value * factor, finding.ours->std * factor};
  if (ours.std > 0.0) return report::with_std(ours, finding.shown.symbol);
  return with_unit(report::compact(ours.value, digits_shown), finding.shown.symbol);
}

std::string against_words(const Finding& finding) {
  if (!is_compared(finding)) return {};
  const std::string ratio = ratio_words(finding);
  if (is_alike(finding) || !is_consistent(finding)) return ratio;
  return ratio + fmt::format(", {} std",
                             report::significant(std::abs(off(finding)) / finding.ours->std, 1));
}

}  // namespace proofmass::thesis
