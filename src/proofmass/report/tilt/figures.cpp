#include "proofmass/report/tilt/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::report {
namespace {

constexpr double two_sided_95 = 1.959964;  // of the normal distribution

std::vector<double> in_degrees(const std::vector<double>& angle_rad) {
  std::vector<double> out(angle_rad);
  for (double& value : out) value *= deg_per_rad;
  return out;
}

Band band(const char* label,
          const std::vector<double>& time_s,
          const std::vector<double>& angle_rad,
          const std::vector<double>& std_rad,
          Ink ink) {
  Band out{.label = label, .x = time_s, .lower = {}, .upper = {}, .ink = ink};
  for (std::size_t k = 0; k < angle_rad.size(); ++k) {
    out.lower.push_back((angle_rad[k] - two_sided_95 * std_rad[k]) * deg_per_rad);
    out.upper.push_back((angle_rad[k] + two_sided_95 * std_rad[k]) * deg_per_rad);
  }
  return out;
}

// Times at which the filter reduced the weight of a measurement to half or less.
Curve down_weighted(const std::vector<double>& time_s, const std::vector<float>& weight) {
  Curve out{"down-weighted", {}, {}, Ink::red, Mark::ticks};
  for (std::size_t k = 0; k < weight.size(); ++k)
    if (weight[k] > 0.0F && weight[k] < 0.5F) out.x.push_back(time_s[k]);
  return out;
}

// Sample numbers if there are no times.
std::vector<double> times_of(const std::vector<double>& time_s, std::size_t size) {
  if (!time_s.empty()) return time_s;
  std::vector<double> numbers(size);
  for (std::size_t k = 0; k < size; ++k) numbers[k] = static_cast<double>(k);
  return numbers;
}

// Excludes the outermost values, so that a single wide band does not compress the rest.
void fit_axis(Figure& figure) {
  std::vector<double> values;
  for (const Curve& curve : figure.curves)
    values.insert(values.end(), curve.y.begin(), curve.y.end());
  const auto low = quantile(values, 0.002), high = quantile(values, 0.998);
  if (!low || !high) return;
  std::vector<double> widths;
  for (const Band& one : figure.bands)
    for (std::size_t k = 0; k < one.upper.size(); ++k)
      widths.push_back(one.upper[k] - one.lower[k]);
  const double room = 0.1 * (*high - *low) + quantile(widths, 0.9).value_or(0.0) + 1e-3;
  figure.y.min = *low - room;
  figure.y.max = *high + room;
}

struct Angle {
  const char* title;
  const char* label;
  const std::vector<double>& smoothed;
  const std::vector<double>& std;
  const std::vector<double>& filtered;
  const std::vector<double>& filtered_std;
};

Figure angle_figure(const Angle& angle,
                    const std::vector<double>& time_s,
                    const std::vector<float>& weight,
                    bool timed) {
  Figure figure{.title = angle.title,
                .description = "Smoothed angle with its 95 % band, and the filter's.",
                .x = {.label = timed ? "Time (s)" : "Sample"},
                .y = {.label = angle.label}};
  figure.bands = {band("filter, 95 %", time_s, angle.filtered, angle.filtered_std, Ink::green),
                  band("smoother, 95 %", time_s, angle.smoothed, angle.std, Ink::blue)};
  figure.curves = {{"filter", time_s, in_degrees(angle.filtered), Ink::green, Mark::thin},
                   {"smoother", time_s, in_degrees(angle.smoothed), Ink::blue}};
  fit_axis(figure);
  if (Curve ticks = down_weighted(time_s, weight); !ticks.x.empty())
    figure.curves.push_back(std::move(ticks));
  return figure;
}

}  // namespace

Figure roll_figure(const estimate::TiltSolution& solution) {
  const estimate::TiltSeries& s = solution.series;
  return angle_figure({"Roll", "Roll (°)", s.roll_rad, s.roll_std_rad, s.filtered_roll_rad,
                       s.filtered_roll_std_rad},
                      times_of(s.time_s, solution.samples), s.weight, !s.time_s.empty());
}

Figure pitch_figure(const estimate::TiltSolution& solution) {
  const estimate::TiltSeries& s = solution.series;
  return angle_figure({"Pitch", "Pitch (°)", s.pitch_rad, s.pitch_std_rad, s.filtered_pitch_rad,
                       s.filtered_pitch_std_rad},
                      times_of(s.time_s, solution.samples), s.weight, !s.time_s.empty());
}

Figure gravity_figure(const estimate::TiltSolution& solution) {
  const estimate::TiltSeries& s = solution.series;
  const std::vector<double> time_s = times_of(s.time_s, solution.samples);
  Figure figure{.title = "Direction of gravity",
                .description =
                    "Elevation of each axis of the sensor above the horizontal, "
                    "smoothed; defined in every attitude.",
                .x = {.label = s.time_s.empty() ? "Sample" : "Time (s)"},
                .y = {.label = "Elevation (°)"}};
  constexpr std::array names{"x", "y", "z"};
  constexpr std::array inks{Ink::blue, Ink::green, Ink::red};
  for (std::size_t i = 0; i < 3; ++i) {
    Curve curve{names[i], time_s, {}, inks[i]};
    for (const double up : s.up[i])
      curve.y.push_back(std::asin(std::clamp(up, -1.0, 1.0)) * deg_per_rad);
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

Figure tilt_std_figure(const estimate::TiltSolution& solution) {
  const estimate::TiltSeries& s = solution.series;
  const std::vector<double> time_s = times_of(s.time_s, solution.samples);
  return {
      .title = "Standard deviation",
      .description = "Of roll and pitch, by filter and smoother.",
      .x = {.label = s.time_s.empty() ? "Sample" : "Time (s)"},
      .y = {.label = "Standard deviation (°)", .scale = AxisScale::log},
      .curves = {
          {"roll, filter", time_s, in_degrees(s.filtered_roll_std_rad), Ink::green, Mark::thin},
          {"roll, smoother", time_s, in_degrees(s.roll_std_rad), Ink::green},
          {"pitch, filter", time_s, in_degrees(s.filtered_pitch_std_rad), Ink::blue, Mark::thin},
          {"pitch, smoother", time_s, in_degrees(s.pitch_std_rad), Ink::blue}}};
}

Figure axis_angle_figure(const estimate::AxisTiltSolution& solution) {
  const estimate::AxisTiltSeries& s = solution.series;
  return angle_figure({"Angle", "Angle (°)", s.angle_rad, s.angle_std_rad, s.filtered_angle_rad,
                       s.filtered_angle_std_rad},
                      s.time_s, s.weight, true);
}

Figure rate_bias_figure(const estimate::AxisTiltSolution& solution) {
  const estimate::AxisTiltSeries& s = solution.series;
  return {.title = "Bias of the gyroscope",
          .description = "Smoothed, with its 95 % band.",
          .x = {.label = "Time (s)"},
          .y = {.label = "Bias (°/s)"},
          .bands = {band("95 %", s.time_s, s.rate_bias_radps, s.rate_bias_std_radps, Ink::blue)},
          .curves = {{"bias", s.time_s, in_degrees(s.rate_bias_radps), Ink::blue}}};
}

}  // namespace proofmass::report
