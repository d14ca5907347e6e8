#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

#include "proofmass/fleet/summary_parts.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

using report::Curve;
using report::Figure;
using report::Ink;
using report::Mark;

void add_levels(const FigureSummary& figure, Figure& plot) {
  for (const Yield& yield : figure.yields)
    plot.levels.push_back({"limit " + yield.limit.text, yield.limit.bound});
  if (figure.type) plot.levels.push_back({"mean of the type", figure.type->mean.value});
}

/// What the values are drawn over.
struct Abscissa {
  std::string title, label;
  std::function<double(const FigureValue&)> of;  ///< gap: not drawn
};

// Each recording's value.
Figure scatter(const FigureSummary& figure, const Abscissa& over) {
  Curve family{.label = "recordings", .x = {}, .y = {}, .ink = Ink::blue, .mark = Mark::points};
  Curve out{
      .label = "of sensors out of family", .x = {}, .y = {}, .ink = Ink::red, .mark = Mark::points};
  for (const FigureValue& value : figure.values) {
    const double x = over.of(value);
    if (!std::isfinite(x)) continue;
    Curve& curve = is_out_of_family(figure, value.sensor) ? out : family;
    curve.x.push_back(x);
    curve.y.push_back(value.value);
  }
  Figure plot{.title = figure_title(figure) + over.title,
              .description = "One point a recording.",
              .x = {.label = over.label},
              .y = {.label = fmt::format("{} ({})", figure.name, report::print_unit(figure.unit))}};
  if (!family.x.empty()) plot.curves.push_back(std::move(family));
  if (!out.x.empty()) plot.curves.push_back(std::move(out));
  add_levels(figure, plot);
  return plot;
}

Figure by_sensor_figure(const FigureSummary& figure) {
  Figure plot = scatter(figure, {" by sensor", "Number of the sensor", [](const FigureValue& one) {
                                   return static_cast<double>(one.sensor + 1);
                                 }});
  constexpr double beside = 0.5;
  double last = 0.0;
  for (const FigureValue& one : figure.values)
    last = std::max(last, static_cast<double>(one.sensor + 1));
  plot.x.min = beside;
  plot.x.max = last + beside;
  return plot;
}

Figure over_date_figure(const FigureSummary& figure) {
  double first_day = std::numeric_limits<double>::infinity();
  for (const FigureValue& one : figure.values)
    if (one.day) first_day = std::min(first_day, std::floor(*one.day));
  const std::chrono::year_month_day date{
      std::chrono::sys_days(std::chrono::days(static_cast<int>(first_day)))};
  const std::string label =
      fmt::format("Days since {}-{:02}-{:02}", static_cast<int>(date.year()),
                  static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  return scatter(figure, {" over time", label, [first_day](const FigureValue& one) {
                            return one.day ? *one.day - first_day : report::gap;
                          }});
}

Figure over_temperature_figure(const FigureSummary& figure) {
  return scatter(figure, {" against temperature", "Temperature (°C)", [](const FigureValue& one) {
                            return one.temperature_c.value_or(report::gap);
                          }});
}

}  // namespace

std::vector<report::Plot> figures_of(const FigureSummary& figure) {
  std::vector<report::Plot> plots{[&figure] { return by_sensor_figure(figure); }};
  if (figure.per_day) plots.emplace_back([&figure] { return over_date_figure(figure); });
  if (figure.per_kelvin) plots.emplace_back([&figure] { return over_temperature_figure(figure); });
  return plots;
}

}  // namespace proofmass::fleet
