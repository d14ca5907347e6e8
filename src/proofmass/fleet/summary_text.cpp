#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

#include "proofmass/fleet/summary_words.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

using report::compact;

constexpr int digits = 4;

std::string between(const Bounds& bounds) {
  return fmt::format("{} … {}", compact(bounds.lower, digits), compact(bounds.upper, digits));
}

void add_trend(const Summary& summary,
               const FigureSummary& figure,
               const std::optional<Trend>& trend,
               double adjusted_p,
               const char* per,
               std::vector<std::vector<std::string>>& rows) {
  if (!trend || !(adjusted_p <= summary.false_share)) return;
  rows.push_back({figure_title(figure), report::with_std(trend->slope, figure.unit) + " per " + per,
                  fmt::format("p {} adjusted", compact(adjusted_p, 2)),
                  trend->within_sensors ? "" : "between sensors, of which none was seen twice"});
}

std::string headed(const char* heading, const std::vector<std::vector<std::string>>& rows) {
  return rows.empty() ? "" : fmt::format("\n{}\n{}", heading, report::aligned(rows));
}

}  // namespace

std::string figure_title(const FigureSummary& figure) {
  return figure.channel.empty() ? figure.name : figure.channel + ": " + figure.name;
}

std::vector<std::vector<std::string>> outlier_rows(const Summary& summary) {
  std::vector<std::vector<std::string>> rows;
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers)
      rows.push_back({summary.sensors[one.sensor], figure_title(figure),
                      compact(one.mean, digits) + " " + figure.unit,
                      figure.type ? "family " + compact(figure.type->mean.value, digits) : "",
                      fmt::format("{} standard deviations", compact(one.z, 3)),
                      fmt::format("p {} adjusted", compact(one.adjusted_p, 2))});
  return rows;
}

std::vector<std::vector<std::string>> type_rows(const Summary& summary) {
  std::vector<std::vector<std::string>> rows;
  for (const FigureSummary& figure : summary.figures) {
    if (!figure.type) continue;
    const RandomEffects& type = *figure.type;
    rows.push_back({figure_title(figure), report::with_std(type.mean, figure.unit),
                    fmt::format("between sensors {} ({})", compact(type.between_std, 3),
                                between(type.between_95)),
                    type.within_std ? fmt::format("within {} ({})", compact(*type.within_std, 3),
                                                  between(type.within_95))
                                    : ""});
  }
  return rows;
}

std::vector<std::vector<std::string>> trend_rows(const Summary& summary) {
  std::vector<std::vector<std::string>> rows;
  for (const FigureSummary& figure : summary.figures) {
    add_trend(summary, figure, figure.per_day, figure.per_day_adjusted_p, "day", rows);
    add_trend(summary, figure, figure.per_kelvin, figure.per_kelvin_adjusted_p, "K", rows);
  }
  return rows;
}

std::vector<std::vector<std::string>> yield_rows(const Summary& summary) {
  constexpr double percent = 100.0;
  std::vector<std::vector<std::string>> rows;
  for (const FigureSummary& figure : summary.figures)
    for (const Yield& yield : figure.yields)
      rows.push_back(
          {figure_title(figure), yield.limit.text,
           fmt::format("{} of {} sensors", yield.within, yield.sensors),
           fmt::format("{} … {} % of the type", compact(percent * yield.share_95.lower, 3),
                       compact(percent * yield.share_95.upper, 3))});
  return rows;
}

std::string conclusion_of(const Summary& summary) {
  std::set<std::string> out;
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers) out.insert(summary.sensors[one.sensor]);
  std::string text =
      fmt::format("{} of {}; {} failed. ", report::count_words(summary.recordings, "recording"),
                  report::count_words(summary.sensors.size(), "sensor"), summary.failures);
  if (summary.family_tests == 0)
    return text + "No figure was measured on enough sensors to say which is out of family.";
  return text + (out.empty() ? "No sensor is out of family."
                             : fmt::format("Out of family: {}.", fmt::join(out, ", ")));
}

std::string summary_text(const Summary& summary) {
  return conclusion_of(summary) + "\n" + headed("Out of family", outlier_rows(summary)) +
         headed("The type, with the family's sensors alone", type_rows(summary)) +
         headed("Dependence on date and temperature", trend_rows(summary)) +
         headed("Yield", yield_rows(summary));
}

}  // namespace proofmass::fleet
