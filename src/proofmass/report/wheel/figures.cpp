#include "proofmass/report/wheel/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/page/thinning.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::WheelSeries;
using estimate::WheelSolution;

constexpr double two_sided_95 = 1.959964;  // of the normal distribution
constexpr double turns_per_rad = 1.0 / rad_per_turn;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> times(const std::vector<double>& values, double factor) {
  std::vector<double> out(values);
  for (double& value : out) value *= factor;
  return out;
}

// values + factor · deviations
std::vector<double> shifted(const std::vector<double>& values,
                            const std::vector<double>& deviations,
                            double factor) {
  std::vector<double> out(values);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += factor * deviations[k];
  return out;
}

std::vector<double> difference_deg(const std::vector<double>& angle,
                                   const std::vector<double>& to) {
  return times(shifted(angle, to, -1.0), deg_per_rad);
}

// From zero, unless the recording begins well after it.
Axis time_axis(const WheelSeries& series) {
  Axis axis{.label = "Time (s)"};
  if (series.time_s.empty()) return axis;
  const double begin = series.time_s.front(), end = series.time_s.back();
  if (begin > 0.0 && begin < 0.02 * end) axis.min = 0.0;
  return axis;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  // Extends the range to all but the outermost 0.2 % of the values at either end.
  void hold(const std::vector<double>& values) {
    const auto bottom = quantile(values, 0.002), top = quantile(values, 0.998);
    if (!bottom || !top) return;
    low = std::min(low, *bottom);
    high = std::max(high, *top);
  }
  void apply_to(Axis& axis) const {
    if (!(high > low)) return;
    axis.min = low - 0.08 * (high - low);
    axis.max = high + 0.08 * (high - low);
  }
};

// Turns by double integration; if it leaves the range, the label states the final value.
Curve double_integral(const WheelSeries& series, const Range& range) {
  Curve curve{.label = "double integration",
              .x = series.time_s,
              .y = times(series.double_integral_angle_rad, turns_per_rad),
              .ink = Ink::red,
              .mark = Mark::dashes};
  const double end = curve.y.back(), room = range.high - range.low;
  if (end < range.low - 0.08 * room || end > range.high + 0.08 * room) {
    curve.label += fmt::format(" (off the figure: ends at {} turns)", significant(end, 3));
  }
  return curve;
}

bool has(const WheelSeries& series, const std::vector<double>& values) {
  return !values.empty() && values.size() == series.time_s.size();
}

// Number of epochs by the number of channels used.
std::array<std::size_t, 256> channels_histogram(const WheelSeries& series) {
  std::array<std::size_t, 256> epochs{};
  for (const unsigned char channels : series.channels_used) ++epochs[channels];
  return epochs;
}

Band band_about_zero(const WheelSeries& series, const std::vector<double>& std_rad) {
  return {.label = {},
          .x = series.time_s,
          .lower = times(std_rad, -two_sided_95 * deg_per_rad),
          .upper = times(std_rad, two_sided_95 * deg_per_rad)};
}

}  // namespace

Figure turns_figure(const WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  Figure figure{.title = "Turns against time",
                .description = "The wheel's angle, counted on from turn to turn, by each method.",
                .x = time_axis(series),
                .y = {.label = "Turns"}};
  Range range;
  const auto add = [&](const char* label, const std::vector<double>& angle_rad, Ink ink) {
    if (!has(series, angle_rad)) return;
    figure.curves.push_back({label, series.time_s, times(angle_rad, turns_per_rad), ink});
    range.hold(figure.curves.back().y);
  };
  add("atan2", series.atan2_angle_rad, Ink::orange);
  add("filter", series.filtered_angle_rad, Ink::green);
  add("smoother", series.angle_rad, Ink::blue);
  if (has(series, series.double_integral_angle_rad)) {
    figure.curves.push_back(double_integral(series, range));
  }
  range.apply_to(figure.y);
  return figure;
}

Figure plain_methods_figure(const WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  Figure figure{.title = "The plain methods against the smoother",
                .description =
                    "What the angle of gravity alone (atan2) and twice integrated "
                    "acceleration miss: their angle minus the smoother's.",
                .x = time_axis(series),
                .y = {.label = "Difference (°)"},
                .levels = {{"", 0.0}}};
  Range range;
  if (has(series, series.atan2_angle_rad)) {
    figure.curves.push_back({"atan2 − smoother", series.time_s,
                             difference_deg(series.atan2_angle_rad, series.angle_rad),
                             Ink::orange});
    range.hold(figure.curves.back().y);
  }
  if (has(series, series.double_integral_angle_rad)) {
    figure.curves.push_back({"double integration − smoother", series.time_s,
                             difference_deg(series.double_integral_angle_rad, series.angle_rad),
                             Ink::red, Mark::dashes});
    const double end = figure.curves.back().y.back();
    figure.curves.back().label += fmt::format(" (ends at {}°)", significant(end, 3));
    if (figure.curves.size() == 1) range.hold(figure.curves.back().y);
  }
  range.apply_to(figure.y);
  return figure;
}

Figure filter_figure(const WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  Figure figure{.title = "Filter against smoother, with their bands",
                .description =
                    "The filter uses past measurements only, the smoother the whole "
                    "recording. The filter's error should stay inside its band 95 % of "
                    "the time.",
                .x = time_axis(series),
                .y = {.label = "Difference (°)"}};
  Band filter = band_about_zero(series, series.filtered_angle_std_rad);
  filter.label = "filter, 95 %";
  filter.ink = Ink::green;
  Band smoother = band_about_zero(series, series.angle_std_rad);
  smoother.label = "smoother, 95 %";
  Curve curve{"filter − smoother", series.time_s,
              difference_deg(series.filtered_angle_rad, series.angle_rad), Ink::green};
  // Before convergence the filter's band may be many turns wide; the range is chosen for the rest.
  const double reach = 3.0 * std::max(quantile(filter.upper, 0.8).value_or(0.0),
                                      quantile(smoother.upper, 0.98).value_or(0.0));
  if (reach > 0.0) {
    figure.y.min = -reach;
    figure.y.max = reach;
  }
  figure.bands = {std::move(filter), std::move(smoother)};
  figure.curves = {std::move(curve)};
  return figure;
}

Figure angle_std_figure(const WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  return {
      .title = "Standard deviation of the angle",
      .description = "Uncertainty of the angle against time, for filter and smoother.",
      .x = time_axis(series),
      .y = {.label = "Standard deviation (°)", .scale = AxisScale::log},
      .curves = {
          {"filter", series.time_s, times(series.filtered_angle_std_rad, deg_per_rad), Ink::green},
          {"smoother", series.time_s, times(series.angle_std_rad, deg_per_rad), Ink::blue}}};
}

Figure speed_figure(const WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  constexpr double rpm = 1.0 / radps_per_rpm;
  return {
      .title = "Speed",
      .description = "Smoothed speed of the wheel with its 95 % band.",
      .x = time_axis(series),
      .y = {.label = "Speed (rpm)"},
      .bands = {{"95 % band", series.time_s,
                 times(shifted(series.speed_radps, series.speed_std_radps, -two_sided_95), rpm),
                 times(shifted(series.speed_radps, series.speed_std_radps, two_sided_95), rpm)}},
      .curves = {{"smoother", series.time_s, times(series.speed_radps, rpm), Ink::blue}}};
}

Figure innovations_figure(const WheelSolution& solution) {
  const WheelSeries& series = solution.series;
  Figure figure{.title = "Innovations",
                .description =
                    "Squared innovations of the filter divided by their variance. If the "
                    "noise parameters are correct, one in twenty is above the 95 % "
                    "level.",
                .x = time_axis(series),
                .y = {.label = "NIS", .scale = AxisScale::log}};
  std::vector<double> nis(series.nis.begin(), series.nis.end());
  for (std::size_t k = 0; k < nis.size(); ++k) {
    if (series.channels_used[k] == 0) nis[k] = none;
  }
  Envelope largest = thinned_band(series.time_s, nis, nis);
  figure.curves.push_back({nis.size() > largest.x.size() ? "NIS, largest of each interval" : "NIS",
                           std::move(largest.x), std::move(largest.upper), Ink::blue});
  const std::array<std::size_t, 256> epochs = channels_histogram(series);
  for (int channels = 1; channels < 256; ++channels) {
    if (epochs[static_cast<std::size_t>(channels)] * 20 < nis.size() || nis.empty()) continue;
    const double level = chi_square_quantile(0.95, channels);
    figure.levels.push_back(
        {fmt::format("95 % level for {}: {}",
                     count_words(static_cast<std::size_t>(channels), "channel"), fixed(level, 2)),
         level});
  }
  Curve gated{"measurements rejected", {}, {}, Ink::red, Mark::ticks};
  for (std::size_t k = 0; k < series.channels_gated.size(); ++k) {
    if (series.channels_gated[k] != 0) gated.x.push_back(series.time_s[k]);
  }
  if (!gated.x.empty()) figure.curves.push_back(std::move(gated));
  return figure;
}

}  // namespace proofmass::report
