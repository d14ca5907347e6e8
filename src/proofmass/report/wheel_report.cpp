#include "proofmass/report/wheel_report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::WheelMethod;
using estimate::WheelSolution;
using Rows = std::vector<std::vector<std::string>>;

// Less than a turn reads better in degrees.
std::string how_far(const Uncertain& turns) {
  const Uncertain size{std::abs(turns.value), turns.std};
  const std::string way = turns.value < 0.0 ? "backwards" : "forwards";
  if (size.value >= 1.0) return fmt::format("turned {} times {}", with_std(size), way);
  return fmt::format("turned by {} {}", with_std(*scaled(size, 360.0), "degrees"), way);
}

std::vector<std::string> method_row(const char* name, const WheelMethod& method) {
  return {name, with_std(method.turns, "", "none"), method.note};
}

Rows sensor_rows(const WheelSolution& solution) {
  Rows rows{{"sensor"}, {"radius"}, {"bias"}, {""}, {"scale"}, {""}, {"noise"}, {"rows used"}};
  Rows gyro{{"gyroscope scale"}, {"gyroscope bias"}};
  bool any_gyro = false;
  for (const auto& sensor : solution.sensors) {
    rows[0].push_back(file_name(sensor.name));
    rows[1].push_back(with_std(scaled(sensor.radius_m, 1e3), "mm", absent));
    rows[2].push_back(with_std(sensor.bias_mps2[0], "m/s²", absent));
    rows[3].push_back(with_std(sensor.bias_mps2[1], "m/s²", absent));
    rows[4].push_back(with_std(sensor.scale[0], "", absent));
    rows[5].push_back(with_std(sensor.scale[1], "", absent));
    any_gyro = any_gyro || sensor.has_gyro;
    gyro[0].push_back(with_std(sensor.gyro_scale, "", absent));
    gyro[1].push_back(with_std(sensor.gyro_bias_radps, "rad/s", absent));
    rows[6].push_back(significant(sensor.noise_mps2, 2) + " m/s²");
    const std::size_t left_out = std::min(sensor.samples, sensor.unusable + sensor.gated);
    rows[7].push_back(grouped(sensor.samples - left_out) + " of " + grouped(sensor.samples));
  }
  if (any_gyro) rows.insert(rows.end(), gyro.begin(), gyro.end());
  return rows;
}

Channel channel(const char* name, const char* unit, const std::vector<double>& values) {
  return {name, parse_unit(unit).value_or(Unit{Quantity::unknown, 1.0, 0.0, unit}), values};
}

}  // namespace

namespace {

// "The wheel turned 19.53 (probability 0.6) or 20.53 (0.4) times in 60 s"
std::string either_words(const WheelSolution& solution, const std::string& when) {
  std::string text = "The wheel turned ";
  for (std::size_t i = 0; i < solution.turns_candidates.size(); ++i) {
    const estimate::TurnsCandidate& one = solution.turns_candidates[i];
    text += fmt::format("{}{} ({}{})", i == 0 ? "" : " or ", fixed(one.turns.value, 2),
                        i == 0 ? "probability " : "", significant(one.probability, 2));
  }
  return text + " times" + when;
}

}  // namespace

std::string wheel_conclusion(const WheelSolution& solution) {
  const std::vector<double>& time_s = solution.series.time_s;
  const std::string when =
      time_s.empty() ? "" : " in " + duration_words(time_s.back() - time_s.front());
  const std::string far = solution.turns_candidates.size() > 1 ? either_words(solution, when)
                          : solution.turns
                              ? fmt::format("The wheel {}{}", how_far(*solution.turns), when)
                              : fmt::format(
                                    "How far the wheel turned{} cannot be told from this "
                                    "recording",
                                    when);
  if (!solution.peak_speed_radps) return far + ".";
  const double rpm = std::abs(solution.peak_speed_radps->value) / radps_per_rpm;
  return fmt::format("{}; top speed {} rpm.", far, significant(rpm, 3));
}

std::string wheel_delay(const WheelReport& report) {
  const Uncertain& delay = report.solution.delay_s;
  const std::string late = with_std(*scaled(delay, 1e3), "ms");
  if (report.options.bandwidth_hz)
    return fmt::format("The sensor's filter ({} Hz) delays the angle by {}: taken out.",
                       significant(*report.options.bandwidth_hz, 3), late);
  return fmt::format(
      "The sensor's filter was taken to delay the angle by {}: give --bandwidth to "
      "know it.",
      late);
}

std::string wheel_text(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  std::string text = wheel_conclusion(solution) + "\n\n";
  const std::string path_of =
      solution.distance_of.empty() ? "" : "path of " + file_name(solution.distance_of);
  text += aligned(
      {{"turns", with_std(solution.turns, "", absent)},
       {"distance", with_std(solution.distance_m, "m", absent), path_of},
       {"final angle", with_std(scaled(solution.angle_final_rad, 1.0 / rad_per_deg), "°", absent)},
       {"top speed",
        with_std(scaled(solution.peak_speed_radps, 1.0 / radps_per_rpm), "rpm", absent)}});
  text += '\n' + aligned({{"method", "turns"},
                          method_row("smoother", solution.smoother),
                          method_row("filter (EKF)", solution.ekf),
                          method_row("atan2", solution.atan2),
                          method_row("double integration", solution.double_integration)});
  text += '\n' + aligned(sensor_rows(solution));
  text += "\n  " + wheel_delay(report) + '\n';
  text += "\n  Consistency: " + nis_words(solution.consistency) + ".\n";
  text += "  " + consistency_conclusion(solution.consistency) + '\n';
  text += fmt::format("  Rejected: {}.\n", count_words(solution.rejected_samples, "row"));
  if (!solution.not_observable.empty()) text += "\nWhat this recording cannot tell:\n";
  for (const std::string& sentence : solution.not_observable) text += "  - " + sentence + '\n';
  return text;
}

Recording wheel_series(const WheelReport& report) {
  const estimate::WheelSeries& series = report.solution.series;
  Recording out;
  out.source = "proofmass wheel";
  out.format = "series";
  out.time.source = TimeSource::stamps;
  out.time.stamps_s = series.time_s;
  out.channels = {channel("angle", "rad", series.angle_rad),
                  channel("angle_std", "rad", series.angle_std_rad),
                  channel("speed", "rad/s", series.speed_radps),
                  channel("speed_std", "rad/s", series.speed_std_radps),
                  channel("accel", "rad/s^2", series.accel_radps2),
                  channel("accel_std", "rad/s^2", series.accel_std_radps2),
                  channel("filtered_angle", "rad", series.filtered_angle_rad),
                  channel("filtered_angle_std", "rad", series.filtered_angle_std_rad),
                  channel("atan2_angle", "rad", series.atan2_angle_rad),
                  channel("double_integral_angle", "rad", series.double_integral_angle_rad)};
  // A method that had nothing to say has no column.
  std::erase_if(out.channels,
                [&](const Channel& c) { return c.values.size() != series.time_s.size(); });
  return out;
}

}  // namespace proofmass::report
