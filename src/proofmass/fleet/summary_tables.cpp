#include <fmt/format.h>
#include <map>
#include <utility>

#include "proofmass/fleet/summary_parts.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

using report::compact;
using report::Table;

constexpr int digits = 4;

std::string between(const Bounds& bounds) {
  return fmt::format("{} … {}", compact(bounds.lower, 3), compact(bounds.upper, 3));
}

std::string unit_of(const FigureSummary& figure) {
  return report::print_unit(figure.unit);
}

void add_trend(const Summary& summary, const FigureSummary& figure, bool over_date, Table& table) {
  const auto& trend = over_date ? figure.per_day : figure.per_kelvin;
  const double adjusted_p = over_date ? figure.per_day_adjusted_p : figure.per_kelvin_adjusted_p;
  if (!trend || !(adjusted_p <= summary.false_share)) return;
  table.rows.push_back(
      {figure_title(figure),
       report::with_std(trend->slope, unit_of(figure)) + (over_date ? " per day" : " per K"),
       compact(adjusted_p, 2),
       trend->within_sensors ? "within sensors" : "between sensors, none of which was seen twice"});
}

}  // namespace

Table outlier_table(const Summary& summary) {
  Table table{.caption = "",
              .head = {"Sensor", "Figure", "Mean", "Type", "Distance (robust σ)", "Adjusted p"},
              .rows = {},
              .long_list = true};
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers)
      table.rows.push_back(
          {summary.sensors[one.sensor], figure_title(figure),
           compact(one.mean, digits) + " " + unit_of(figure),
           figure.type ? compact(figure.type->mean.value, digits) + " " + unit_of(figure) : "–",
           compact(one.z, 3), compact(one.adjusted_p, 2)});
  return table;
}

Table outlier_recordings_table(const Summary& summary, const std::string& links) {
  Table table{.caption = "Recordings of these sensors",
              .head = {"Recording", "Sensor", "Out of family in"},
              .rows = {},
              .page_only = true,
              .long_list = true};
  std::map<std::pair<std::size_t, std::string>, std::size_t> places;  // by sensor and file
  for (const FigureSummary& figure : summary.figures)
    for (const FigureValue& value : figure.values) {
      if (!is_out_of_family(figure, value.sensor)) continue;
      const auto [place, is_new] =
          places.try_emplace({value.sensor, value.file}, table.rows.size());
      if (is_new) {
        table.rows.push_back({report::file_name(value.file), summary.sensors[value.sensor], ""});
        table.links.push_back(links + value.page);
      }
      std::string& figures = table.rows[place->second].back();
      figures += (figures.empty() ? "" : ", ") + figure_title(figure);
    }
  return table;
}

Table type_table(const Summary& summary) {
  Table table{.caption = "Sensors in the family alone, with 95 % intervals",
              .head = {"Figure", "Mean", "95 %", "Std between sensors", "Std within a sensor"},
              .rows = {}};
  const auto with_bounds = [](double std, const Bounds& bounds) {
    return fmt::format("{} ({})", compact(std, 3), between(bounds));
  };
  for (const FigureSummary& figure : summary.figures) {
    if (!figure.type) continue;
    const RandomEffects& type = *figure.type;
    table.rows.push_back({figure_title(figure), report::with_std(type.mean, unit_of(figure)),
                          between(type.mean_95), with_bounds(type.between_std, type.between_95),
                          type.within_std ? with_bounds(*type.within_std, type.within_95) : "–"});
  }
  return table;
}

Table trend_table(const Summary& summary) {
  Table table{.caption = "Slopes that are significant over all figures together",
              .head = {"Figure", "Slope", "Adjusted p", "Found"},
              .rows = {}};
  for (const FigureSummary& figure : summary.figures)
    for (const bool over_date : {true, false}) add_trend(summary, figure, over_date, table);
  return table;
}

Table yield_table(const Summary& summary) {
  constexpr double percent = 100.0;
  Table table{.caption = "Sensors within the limits, by the mean of each",
              .head = {"Figure", "Limit", "Sensors within it", "Share of the type, 95 %"},
              .rows = {}};
  for (const FigureSummary& figure : summary.figures)
    for (const Yield& yield : figure.yields)
      table.rows.push_back({figure_title(figure), yield.limit.text,
                            fmt::format("{} of {}", yield.within, yield.sensors),
                            fmt::format("{} … {} %", compact(percent * yield.share_95.lower, 3),
                                        compact(percent * yield.share_95.upper, 3))});
  return table;
}

Table quantiles_table(const Summary& summary) {
  Table table{.caption = "",
              .head = {"Figure", "Unit", "Recordings", "Smallest", "5 %", "25 %", "Median", "75 %",
                       "95 %", "Largest"},
              .rows = {},
              .page_only = true};
  for (const FigureSummary& figure : summary.figures) {
    const Quantiles& q = figure.quantiles;
    std::vector<std::string> row{figure_title(figure), unit_of(figure),
                                 report::grouped(figure.values.size())};
    for (const double value : {q.min, q.p05, q.p25, q.median, q.p75, q.p95, q.max})
      row.push_back(compact(value, digits));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace proofmass::fleet
