#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/fleet/summary_parts.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

using report::Curve;
using report::Figure;
using report::Ink;
using report::Mark;

bool is_out(const FigureSummary& figure, std::size_t sensor) {
  return std::ranges::any_of(figure.outliers,
                             [&](const Outlier& one) { return one.sensor == sensor; });
}

void add_levels(const FigureSummary& figure, Figure& plot) {
  for (const Yield& yield : figure.yields)
    plot.levels.push_back({"limit " + yield.limit.text, yield.limit.bound});
  if (figure.type) plot.levels.push_back({"mean of the type", figure.type->mean.value});
}

// Each recording's value over its sensor, or over what it may depend on.
Figure scatter(const FigureSummary& figure,
               const std::string& title,
               const std::string& x_label,
               double (*x_of)(const FigureValue&)) {
  Curve family{.label = "recordings", .x = {}, .y = {}, .ink = Ink::blue, .mark = Mark::points};
  Curve out{
      .label = "of sensors out of family", .x = {}, .y = {}, .ink = Ink::red, .mark = Mark::points};
  for (const FigureValue& value : figure.values) {
    const double x = x_of(value);
    if (!std::isfinite(x)) continue;
    Curve& curve = is_out(figure, value.sensor) ? out : family;
    curve.x.push_back(x);
    curve.y.push_back(value.value);
  }
  Figure plot{.title = title,
              .description = "One point a recording.",
              .x = {.label = x_label},
              .y = {.label = fmt::format("{} ({})", figure.name, report::print_unit(figure.unit))}};
  if (!family.x.empty()) plot.curves.push_back(std::move(family));
  if (!out.x.empty()) plot.curves.push_back(std::move(out));
  add_levels(figure, plot);
  return plot;
}

double sensor_number(const FigureValue& value) {
  return static_cast<double>(value.sensor + 1);
}
double day_number(const FigureValue& value) {
  return value.day.value_or(report::gap);
}
double temperature_of(const FigureValue& value) {
  return value.temperature_c.value_or(report::gap);
}

}  // namespace

std::vector<report::Plot> figures_of(const FigureSummary& figure) {
  const auto over = [&figure](const char* title, const char* x_label,
                              double (*x_of)(const FigureValue&)) {
    return [&figure, title, x_label, x_of] {
      return scatter(figure, figure_title(figure) + title, x_label, x_of);
    };
  };
  std::vector<report::Plot> plots{over(" by sensor", "Number of the sensor", sensor_number)};
  if (figure.per_day) plots.push_back(over(" over time", "Days since 1970", day_number));
  if (figure.per_kelvin)
    plots.push_back(over(" against temperature", "Temperature (°C)", temperature_of));
  return plots;
}

}  // namespace proofmass::fleet
