#include <fmt/format.h>

#include "proofmass/report/consistency_report.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/tilt_report.hpp"

namespace proofmass::report {
namespace {

using estimate::TiltAngles;
using estimate::TiltSolution;

constexpr std::array axis_names{"x", "y", "z"};

// The reason of every null of these angles.
void add_nulls(const TiltAngles& angles, const std::string& of, std::vector<std::string>& out) {
  if (!angles.roll_rad) out.push_back(of + "roll_rad: null: " + angles.why_no_roll);
  if (!angles.pitch_rad) out.push_back(of + "pitch_rad: null: " + angles.why_no_pitch);
}

Object elevation_json(const TiltAngles& angles, std::vector<std::string>& nulls) {
  Object out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.push_back({axis_names[i], quantity(angles.elevation_rad[i], "rad")});
    if (!angles.elevation_rad[i])
      nulls.push_back(
          fmt::format("elevation_rad.{}: null: the axis was not recorded, or stands nearly upright",
                      axis_names[i]));
  }
  return out;
}

Value inclination_json(const TiltAngles& angles) {
  if (!angles.inclination) return nullptr;
  const estimate::Inclination& one = *angles.inclination;
  return Object{{"axis", axis_names[one.axis]},
                {"up", one.up},
                {"angle_rad", quantity(one.angle_rad, "rad")},
                {"azimuth_rad", quantity(one.azimuth_rad, "rad")}};
}

Array rests_json(const TiltSolution& solution, std::vector<std::string>& nulls) {
  Array out;
  for (const estimate::TiltRest& rest : solution.rests) {
    Object item{{"first_sample", rest.first}, {"last_sample", rest.last}};
    if (!solution.series.time_s.empty()) {
      item.push_back({"start_s", solution.series.time_s[rest.first]});
      item.push_back({"end_s", solution.series.time_s[rest.last]});
    }
    item.push_back({"roll_rad", quantity(rest.angles.roll_rad, "rad")});
    item.push_back({"pitch_rad", quantity(rest.angles.pitch_rad, "rad")});
    if (rest.norm_mps2) item.push_back({"norm_mps2", quantity(rest.norm_mps2, "m/s^2")});
    add_nulls(rest.angles, fmt::format("rests[{}].", out.size()), nulls);
    out.push_back(std::move(item));
  }
  return out;
}

Object motion_json(const estimate::TiltMotion& motion) {
  return {{"gyroscope", motion.gyroscope},
          {motion.gyroscope ? "rate_noise_radps_rthz" : "angular_accel_radps2_rthz", motion.drive},
          {"accel_std_mps2", motion.accel_std_mps2},
          {"accel_time_s", motion.accel_time_s},
          {"reading_std_mps2", motion.reading_std_mps2},
          {"gravity_mps2", motion.gravity_mps2},
          {"log_likelihood", motion.log_likelihood}};
}

Object axis_body(const estimate::AxisTiltSolution& axis) {
  const estimate::AxisTiltNoise& noise = axis.noise;
  return {{"mode", "angle"},
          {"samples", axis.samples},
          {"unusable", axis.unusable},
          {"told_less", axis.told_less},
          {"roll_rad", nullptr},
          {"pitch_rad", nullptr},
          {"angle_rad", quantity(axis.angle_rad, "rad")},
          {"rate_bias_radps", Array{quantity(axis.rate_bias_radps, "rad/s")}},
          {"noise", Object{{"rate_noise_radps_rthz", noise.rate_noise_radps_rthz},
                           {"rate_bias_walk_radps_rts", noise.rate_bias_walk_radps_rts},
                           {"motion_std_rad", noise.motion_std_rad},
                           {"motion_time_s", noise.motion_time_s},
                           {"reading_std_rad", noise.reading_std_rad},
                           {"log_likelihood", noise.log_likelihood},
                           {"converged", noise.converged}}},
          {"consistency", consistency_json(axis.consistency)}};
}

Object tilt_body(const TiltSolution& solution, std::vector<std::string>& nulls) {
  Object body{{"mode", solution.moving ? "moving" : "still"},
              {"samples", solution.samples},
              {"unusable", solution.unusable},
              {"told_less", solution.told_less},
              {"axes", solution.axes},
              {"roll_rad", quantity(solution.final.roll_rad, "rad")},
              {"pitch_rad", quantity(solution.final.pitch_rad, "rad")},
              {"elevation_rad", elevation_json(solution.final, nulls)}};
  add_nulls(solution.final, "", nulls);
  body.push_back({"inclination", inclination_json(solution.final)});
  if (!solution.final.inclination)
    nulls.emplace_back("inclination: null: it takes three axes and a direction that is known");
  else if (!solution.final.inclination->azimuth_rad)
    nulls.emplace_back(
        "inclination.azimuth_rad: null: the axis is vertical within its uncertainty");
  body.push_back({"bias_std_mps2", solution.bias_std_mps2});
  if (solution.axes == 3)
    body.push_back({"std_from", Object{{"noise_rad", solution.shares.noise},
                                       {"calibration_rad", solution.shares.calibration},
                                       {"alignment_rad", solution.shares.alignment}}});
  body.push_back({"rests", rests_json(solution, nulls)});
  if (solution.motion) body.push_back({"motion", motion_json(*solution.motion)});
  if (solution.rate_bias_radps) {
    Array biases;
    for (const Uncertain& bias : *solution.rate_bias_radps)
      biases.push_back(quantity(bias, "rad/s"));
    body.push_back({"rate_bias_radps", std::move(biases)});
  }
  if (solution.consistency)
    body.push_back({"consistency", consistency_json(*solution.consistency)});
  return body;
}

}  // namespace

std::string tilt_json(const TiltReport& report) {
  std::vector<std::string> warnings = texts(tilt_notes(report), Severity::warning);
  std::vector<std::string> nulls;
  Object body = report.axis ? axis_body(*report.axis) : tilt_body(*report.solution, nulls);
  if (report.axis)
    nulls.emplace_back("roll_rad, pitch_rad: null: the recording holds one angle, see angle_rad");
  const auto& consistency =
      report.axis ? std::optional(report.axis->consistency) : report.solution->consistency;
  if (consistency)
    for (std::string& reason : consistency_nulls(*consistency)) nulls.push_back(std::move(reason));
  warnings.insert(warnings.end(), nulls.begin(), nulls.end());
  if (!report.axis) {
    body.push_back({"gravity_mps2", quantity(report.gravity_mps2, "m/s^2")});
    body.push_back({"reads", report.reads_minus_g ? "-g" : "+g"});
  }
  body.push_back({"notes", array_of(texts(tilt_notes(report), Severity::info))});
  return to_json({"tilt", report.inputs, warnings}, body);
}

}  // namespace proofmass::report
