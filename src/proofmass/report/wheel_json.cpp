#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/wheel_report.hpp"

namespace proofmass::report {
namespace {

using estimate::WheelMethod;
using estimate::WheelSensorFit;
using estimate::WheelSolution;

constexpr double rpm_per_radps = 1.0 / radps_per_rpm;

Value method(const WheelMethod& method) {
  if (!method.turns) {
    return Object{{"turns", nullptr}, {"turns_std", nullptr}, {"note", method.note}};
  }
  return Object{{"turns", method.turns->value},
                {"turns_std", method.turns->std > 0.0 ? Value(method.turns->std) : Value()},
                {"note", method.note}};
}

Value pair(const std::array<std::optional<Uncertain>, 2>& figures, const char* unit) {
  return Array{quantity(figures[0], unit), quantity(figures[1], unit)};
}

// What stands between two sensors is zero of the first and itself, and so is the offset of a clock
// that both share.
Value against_first(const std::optional<Uncertain>& figure, bool zero, const char* unit) {
  return quantity(!figure && zero ? Uncertain{0.0, 0.0} : figure, unit);
}

Value sensor(const WheelSensorFit& fit, bool first, bool clocks_shared) {
  return Object{{"file", fit.name},
                {"radius_m", quantity(fit.radius_m, "m")},
                {"bias", pair(fit.bias_mps2, "m/s^2")},
                {"scale", pair(fit.scale, "1")},
                {"spin_axis", array_of(fit.spin_axis)},
                {"spin_axis_given", fit.spin_axis_given},
                {"mounting_rad", quantity(fit.mounting_rad, "rad")},
                {"skew_rad", quantity(fit.skew_rad, "rad")},
                {"phase_rad", against_first(fit.phase_rad, first, "rad")},
                {"clock_offset_s", against_first(fit.clock_offset_s, first || clocks_shared, "s")},
                {"noise_mps2", fit.noise_mps2},
                {"samples", fit.samples},
                {"unusable", fit.unusable},
                {"gated", fit.gated}};
}

/// Of the first sensor that has one.
Value gyroscope(const WheelSolution& solution) {
  const auto fit = std::ranges::find_if(solution.sensors, &WheelSensorFit::has_gyro);
  if (fit == solution.sensors.end()) return Value();
  return Object{{"bias", quantity(fit->gyro_bias_radps, "rad/s")},
                {"scale", quantity(fit->gyro_scale, "1")}};
}

Array stretches(const std::vector<estimate::Stretch>& rejected) {
  Array items;
  for (const estimate::Stretch& stretch : rejected) {
    items.push_back(Object{{"start_s", stretch.start_s},
                           {"end_s", stretch.end_s},
                           {"rows", stretch.rows},
                           {"reason", stretch.reason}});
  }
  return items;
}

// The figures that a sensor lacks, in one sentence; empty if it lacks none.
std::string lacking(const WheelSensorFit& fit, bool first, bool clocks_shared) {
  std::string names;
  const auto look = [&](const auto& figure, const char* name) {
    if (!figure) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  look(fit.radius_m, "radius_m");
  look(fit.bias_mps2[0], "bias[0]");
  look(fit.bias_mps2[1], "bias[1]");
  look(fit.scale[0], "scale[0]");
  look(fit.scale[1], "scale[1]");
  look(fit.mounting_rad, "mounting_rad");
  look(fit.skew_rad, "skew_rad");
  if (fit.has_gyro) look(fit.gyro_bias_radps, "gyroscope.bias");
  if (fit.has_gyro) look(fit.gyro_scale, "gyroscope.scale");
  if (!first) look(fit.phase_rad, "phase_rad");
  if (!first && !clocks_shared) look(fit.clock_offset_s, "clock_offset_s");
  if (names.empty()) return names;
  return fmt::format("{}: null for {}: this recording does not determine them", fit.name, names);
}

// Every null has its reason here.
Array candidates(const WheelSolution& solution) {
  Array out;
  for (const estimate::TurnsCandidate& one : solution.turns_candidates)
    out.push_back(Object{
        {"value", one.turns.value}, {"std", one.turns.std}, {"probability", one.probability}});
  return out;
}

std::vector<std::string> warnings(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  std::vector<std::string> all = texts(report.notes, Severity::warning);
  const auto add = [&](std::vector<std::string> more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(texts(solution.notes, Severity::warning));
  add(solution.not_observable);
  add(consistency_nulls(solution.consistency));
  const auto missing = [&](const auto& figure, const std::string& name, const std::string& why) {
    if (!figure) {
      all.push_back(name +
                    ": null: " + (why.empty() ? "this recording does not determine it" : why));
    }
  };
  missing(solution.turns, "turns", solution.smoother.note);
  missing(solution.distance_m, "distance_m", "no radius is known or determined");
  missing(solution.angle_final_rad, "angle_final_rad", solution.smoother.note);
  missing(solution.peak_speed_radps, "peak_speed_rpm", solution.smoother.note);
  const auto missing_of = [&](const WheelMethod& method, const std::string& name) {
    missing(method.turns, "methods." + name + ".turns", method.note);
    if (!method.turns || method.turns->std > 0.0) return;
    all.push_back("methods." + name + ".turns_std: null: the method itself gives none");
  };
  missing_of(solution.double_integration, "double_integration");
  missing_of(solution.atan2, "atan2");
  missing_of(solution.ekf, "ekf");
  missing_of(solution.smoother, "smoother");
  if (std::ranges::none_of(solution.sensors, &WheelSensorFit::has_gyro))
    all.push_back("gyroscope: null: no gyroscope was used");
  for (const WheelSensorFit& fit : solution.sensors) {
    const std::string sentence =
        lacking(fit, &fit == &solution.sensors.front(), report.options.clocks_shared);
    if (!sentence.empty()) all.push_back(sentence);
  }
  return all;
}

}  // namespace

std::string wheel_json(const WheelReport& report) {
  const WheelSolution& solution = report.solution;
  std::vector<std::string> notes = texts(report.notes, Severity::info);
  for (std::string& text : texts(solution.notes, Severity::info)) notes.push_back(std::move(text));
  Array sensors;
  for (const WheelSensorFit& fit : solution.sensors) {
    sensors.push_back(sensor(fit, &fit == &solution.sensors.front(), report.options.clocks_shared));
  }
  const std::vector<double>& time_s = solution.series.time_s;
  return to_json(
      {"wheel", report.inputs, warnings(report)},
      {{"turns", quantity(solution.turns, "turn")},
       {"turns_candidates", candidates(solution)},
       {"distance_m", quantity(solution.distance_m, "m")},
       {"distance_of", solution.distance_of},
       {"angle_final_rad", quantity(solution.angle_final_rad, "rad")},
       {"peak_speed_rpm", quantity(scaled(solution.peak_speed_radps, rpm_per_radps), "rpm")},
       {"duration_s", time_s.empty() ? 0.0 : time_s.back() - time_s.front()},
       {"gravity_mps2", report.options.gravity_mps2},
       {"clocks_shared", report.options.clocks_shared},
       {"delay_s", quantity(solution.delay_s, "s")},
       {"sensors", std::move(sensors)},
       {"gyroscope", gyroscope(solution)},
       {"rejected_samples", solution.rejected_samples},
       {"rejected", stretches(solution.rejected)},
       {"methods", Object{{"double_integration", method(solution.double_integration)},
                          {"atan2", method(solution.atan2)},
                          {"ekf", method(solution.ekf)},
                          {"smoother", method(solution.smoother)}}},
       {"consistency", consistency_json(solution.consistency)},
       {"not_observable", array_of(solution.not_observable)},
       {"notes", array_of(notes)}});
}

}  // namespace proofmass::report
