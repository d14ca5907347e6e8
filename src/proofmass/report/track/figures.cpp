#include "proofmass/report/track/figures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/statistics.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::Stroke;
using estimate::TrackSeries;
using estimate::TrackSolution;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

Axis time_axis() {
  return {.label = "Time (s)"};
}

// values + factor · deviations
std::vector<double> shifted(const std::vector<double>& values,
                            const std::vector<double>& deviations,
                            double factor) {
  std::vector<double> out(values);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += factor * deviations[k];
  return out;
}

// Range of the values to be shown.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void hold(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void hold(const std::vector<double>& values) {
    for (const double value : values) hold(value);
  }
  // Excludes the outermost 2 % at either end.
  void hold_most(const std::vector<double>& values) {
    hold(quantile(values, 0.02).value_or(none));
    hold(quantile(values, 0.98).value_or(none));
  }
  void apply_to(Axis& axis) const {
    if (!(high > low)) return;
    axis.min = low - 0.08 * (high - low);
    axis.max = high + 0.08 * (high - low);
  }
};

// Over the full height of a plot with fixed range.
void shade_rests(const TrackSolution& solution, Figure& figure) {
  if (!figure.y.min || !figure.y.max || solution.rests.empty()) return;
  const std::vector<double>& time_s = solution.series.time_s;
  Band band{.label = "at rest", .x = {}, .lower = {}, .upper = {}, .ink = Ink::grey};
  const auto add = [&band](double x, double lower, double upper) {
    band.x.push_back(x);
    band.lower.push_back(lower);
    band.upper.push_back(upper);
  };
  for (const signal::Rest& rest : solution.rests) {
    add(time_s[rest.first], *figure.y.min, *figure.y.max);
    add(time_s[rest.last], *figure.y.min, *figure.y.max);
    add(time_s[rest.last], none, none);
  }
  figure.bands.insert(figure.bands.begin(), std::move(band));
}

// Number of each stroke at its turning point, if there is room.
void mark_strokes(const TrackSolution& solution, Figure& figure) {
  constexpr std::size_t most_numbers = 15;
  const TrackSeries& series = solution.series;
  Curve ends{"strokes", {}, {}, Ink::purple, Mark::points};
  for (std::size_t i = 0; i < solution.strokes.size(); ++i) {
    const Stroke& stroke = solution.strokes[i];
    const double y = series.position_m[stroke.turn];
    ends.x.insert(ends.x.end(), {stroke.start_s, stroke.turn_s, stroke.end_s});
    for (const std::size_t k : {stroke.first, stroke.turn, stroke.last})
      ends.y.push_back(series.position_m[k]);
    if (solution.strokes.size() > most_numbers) continue;
    figure.callouts.push_back({.text = std::to_string(i + 1),
                               .x = stroke.turn_s,
                               .y = y,
                               .ink = Ink::purple,
                               .below = stroke.out_m.value < 0.0});
  }
  if (!ends.x.empty() && solution.strokes.size() > most_numbers) {
    ends.mark = Mark::ticks;
    figure.curves.push_back(std::move(ends));
  }
}

Curve double_integral(const TrackSeries& series, const Range& range) {
  Curve curve{.label = "double integration",
              .x = series.time_s,
              .y = series.double_integral_m,
              .ink = Ink::red,
              .mark = Mark::dashes};
  const double end = curve.y.back(), room = 0.08 * (range.high - range.low);
  if (end < range.low - room || end > range.high + room)
    curve.label += fmt::format(" (off the figure: ends at {})", length_words(end));
  return curve;
}

}  // namespace

Figure position_figure(const TrackReport& report) {
  const TrackSolution& solution = report.solution;
  const TrackSeries& series = solution.series;
  Figure figure{.title = "Position along the axis",
                .description =
                    "From all measurements (smoother), those so far (filter), and by double "
                    "integration. The true position is in its 95 % band 95 times in 100.",
                .x = time_axis(),
                .y = {.label = "Position (m)"},
                .height = 360.0};
  const double factor = solution.factor_95;
  Band smoothed{"smoother, 95 %", series.time_s,
                shifted(series.position_m, series.position_std_m, -factor),
                shifted(series.position_m, series.position_std_m, factor), Ink::blue};
  Band filtered{"filter, 95 %", series.time_s,
                shifted(series.filtered_position_m, series.filtered_position_std_m, -factor),
                shifted(series.filtered_position_m, series.filtered_position_std_m, factor),
                Ink::green};
  Range range;
  range.hold(smoothed.lower);
  range.hold(smoothed.upper);
  range.hold_most(series.filtered_position_m);
  Curve fixes{"fixes", {}, {}, Ink::orange, Mark::points};
  const auto& delay_s = report.solution.fix_review.delay_s;
  for (const estimate::PositionFix& fix : report.options.fixes) {
    fixes.x.push_back(fix.time_s - (delay_s ? delay_s->value : 0.0));
    fixes.y.push_back(fix.position_m);
  }
  range.hold(fixes.y);
  range.apply_to(figure.y);
  figure.bands = {std::move(filtered), std::move(smoothed)};
  figure.curves = {double_integral(series, range),
                   {"filter", series.time_s, series.filtered_position_m, Ink::green},
                   {"smoother", series.time_s, series.position_m, Ink::blue}};
  if (!fixes.x.empty()) figure.curves.push_back(std::move(fixes));
  shade_rests(solution, figure);
  mark_strokes(solution, figure);
  return figure;
}

Figure velocity_figure(const TrackSolution& solution) {
  const TrackSeries& series = solution.series;
  const double factor = solution.factor_95;
  Figure figure{.title = "Velocity along the axis",
                .description =
                    "From all measurements, with its 95 % band. Dots are the filter's "
                    "residual velocities at stops, whose true value is 0.",
                .x = time_axis(),
                .y = {.label = "Velocity (m/s)"}};
  Band band{"95 % band", series.time_s,
            shifted(series.velocity_mps, series.velocity_std_mps, -factor),
            shifted(series.velocity_mps, series.velocity_std_mps, factor)};
  Curve left{"residual at a stop", {}, {}, Ink::orange, Mark::points};
  for (const estimate::Closure& closure : solution.closures) {
    left.x.push_back(closure.end_s);
    left.y.push_back(closure.velocity_mps);
  }
  Range range;
  range.hold(band.lower);
  range.hold(band.upper);
  range.hold(left.y);
  range.apply_to(figure.y);
  figure.bands = {std::move(band)};
  figure.curves = {{"smoother", series.time_s, series.velocity_mps, Ink::blue}};
  if (!left.x.empty()) figure.curves.push_back(std::move(left));
  shade_rests(solution, figure);
  return figure;
}

Figure accel_figure(const TrackSolution& solution) {
  const TrackSeries& series = solution.series;
  Figure figure{.title = "Acceleration along the axis",
                .description = "As measured, minus the level of the first rest.",
                .x = time_axis(),
                .y = {.label = "Acceleration (m/s²)"}};
  Range range;
  range.hold(series.accel_mps2);
  range.apply_to(figure.y);
  figure.curves = {{"", series.time_s, series.accel_mps2, Ink::blue, Mark::thin}};
  shade_rests(solution, figure);
  return figure;
}

Figure position_std_figure(const TrackSolution& solution) {
  const TrackSeries& series = solution.series;
  const auto in_mm = [](std::vector<double> values) {
    for (double& value : values) value *= 1e3;
    return values;
  };
  return {.title = "Standard deviation of the position",
          .description = "Uncertainty of the position against time, for filter and smoother.",
          .x = time_axis(),
          .y = {.label = "Standard deviation (mm)", .scale = AxisScale::log},
          .curves = {{"filter", series.time_s, in_mm(series.filtered_position_std_m), Ink::green},
                     {"smoother", series.time_s, in_mm(series.position_std_m), Ink::blue}}};
}

}  // namespace proofmass::report
