#include <algorithm>
#include <cmath>
#include <string>

#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/procedure/fields.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/procedure/slide_fields.hpp"
#include "proofmass/simulate/rig/fields.hpp"
#include "proofmass/simulate/rig/option_check.hpp"

namespace proofmass::simulate {
namespace {

constexpr const char* not_negative = "must not be negative";
constexpr int most_positions = 1000;

void check_timing(const ProcedureTiming& timing, Verdict& verdict) {
  visit_timing(timing, verdict);
  verdict.require(timing.move_s > 0.0, "move_s", "must be positive");
  for (const double jitter : {timing.dwell_jitter, timing.move_jitter})
    verdict.require(jitter >= 0.0 && jitter < 1.0, "jitter", "must lie from 0 to below 1");
  verdict.require(timing.settle_s >= 0.0, "settle_s", not_negative);
  verdict.require(timing.dwell_s * (1.0 - timing.dwell_jitter) > timing.settle_s, "dwell_s",
                  "less its jitter must be longer than settle_s");
}

void check_table(const ProcedureTable& table, Verdict& verdict) {
  visit_table(table, verdict);
  verdict.require(table.positions >= 1 && table.positions <= most_positions, "positions",
                  "must lie between 1 and 1000");
  verdict.require(table.planes == 1 || table.planes == 2, "planes", "must be 1 or 2");
  verdict.require(table.first_plane >= 1 && table.first_plane <= table.planes, "first_plane",
                  "must be 1, or 2 if planes is");
  verdict.require(table.closing || !table.backward, "backward", "needs closing");
  verdict.require(table.remount_s > 0.0, "remount_s", "must be positive");
  verdict.require(std::min(table.position_std_rad, table.setting_std_rad) >= 0.0 &&
                      table.mounting_std_rad >= 0.0,
                  "position_std_deg, setting_std_deg, mounting_std_deg", not_negative);
  verdict.require(table.radius_m >= 0.0, "radius_m", not_negative);
  verdict.require(table.vibration_mps2 >= 0.0, "vibration_mps2", not_negative);
}

void check_hand(const ProcedureHand& hand, Verdict& verdict) {
  visit_hand(hand, verdict);
  verdict.require(hand.poses >= 1 && hand.poses <= most_positions, "poses",
                  "must lie between 1 and 1000");
  verdict.require(hand.initial_rest_s >= 0.0, "initial_rest_s", not_negative);
  verdict.require(hand.bad_pose >= 0, "bad_pose", not_negative);
  verdict.require(std::min({hand.placement_std_rad, hand.lift_m, hand.sway_rms_mps2,
                            hand.tremor_rms_mps2, hand.wobble_rms_rad, hand.bump_mps2}) >= 0.0,
                  "[hand]", not_negative);
}

void check_slide(const ProcedureOptions& options, Verdict& verdict) {
  const ProcedureSlide& slide = options.slide;
  visit_slide(slide, verdict);
  verdict.require(slide.strokes >= 1 && slide.strokes <= most_positions, "strokes",
                  "must lie between 1 and 1000");
  verdict.require(slide.repetitions >= 0 && slide.repetitions <= most_positions, "repetitions",
                  "must lie between 0 and 1000");
  verdict.require(std::abs(slide.length_m) <= 1e3, "length_m", "must lie between -1000 and 1000");
  verdict.require(slide.length_jitter >= 0.0 && slide.length_jitter < 1.0, "length_jitter",
                  "must lie from 0 to below 1");
  verdict.require(std::min({slide.turn_pause_s, slide.turn_std_rad, slide.wobble_rms_rad,
                            slide.vibration_mps2, slide.gyro_bias_spread_radps,
                            slide.gyro_noise_rms_radps, slide.gyro_walk_radps_rts}) >= 0.0,
                  "[slide]", not_negative);
  verdict.require(std::min(slide.initial_rest_s, slide.final_rest_s) * options.rate_hz >= 2.0,
                  "initial_rest_s and final_rest_s", "must each hold at least two samples");
  verdict.require(!slide.gravity_removed || options.output == RigOutput::acceleration,
                  "gravity_removed", "needs an output in m/s²");
}

void check_bench_sensor(const ProcedureSensor& sensor, Verdict& verdict) {
  visit_bench_sensor(sensor, verdict);
  const auto positive = [&](double value, std::string_view key) {
    verdict.require(value > 0.0, key, "must be positive");
  };
  positive(sensor.full_scale_mps2, "full_scale_mps2");
  positive(sensor.warm_up_time_s, "warm_up_time_s");
  positive(sensor.sensitivity_v_per_mps2, "sensitivity_v_per_mps2");
  verdict.require(std::min({sensor.bias_spread_mps2, sensor.scale_spread,
                            sensor.misalignment_spread_rad}) >= 0.0,
                  "bias_spread_mps2, scale_spread, misalignment_spread_deg", not_negative);
  verdict.require(sensor.scale_spread < 1.0, "scale_spread", "must be below 1");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    positive(sensor.scale[axis], "scale");
    positive(sensor.equation[axis].K1, "K1");
    verdict.require(sensor.noise_rms_mps2[axis] >= 0.0, "noise_rms_mps2", not_negative);
    verdict.require(sensor.flicker_mps2[axis] >= 0.0, "flicker_mps2", not_negative);
    verdict.require(sensor.bias_walk_mps2_rts[axis] >= 0.0, "bias_walk_mps2_rts", not_negative);
  }
}

void check_supply(const ProcedureOptions& options, Verdict& verdict) {
  const RigDaq& daq = options.daq;
  visit_bench_supply(options.supply, verdict);
  visit_daq(daq, verdict);
  verdict.require(options.supply.reference_v > 0.0, "reference_v", "must be positive");
  verdict.require(options.supply.actual_v > 0.0, "actual_v", "must be positive");
  for (const double per_v : options.sensor.scale_per_v)
    verdict.require(1.0 + per_v * (options.supply.actual_v - options.supply.reference_v) > 0.0,
                    "scale_per_v", "must leave a positive scale at that supply");
  verdict.require(daq.bits >= 0 && daq.bits <= 32, "bits", "must lie between 0 and 32");
  verdict.require(daq.min_v < daq.max_v, "min_v", "must be below max_v");
  verdict.require(daq.bits > 0 || options.output != RigOutput::counts, "output",
                  "\"counts\" needs a converter; set daq.bits");
}

}  // namespace

Status check(const ProcedureOptions& options) {
  Verdict verdict;
  visit_procedure(options, verdict);
  verdict.require(options.rate_hz > 0.0, "rate_hz", "must be positive");
  verdict.require(options.gravity_mps2 > 0.0, "gravity_mps2", "must be positive");
  check_timing(options.timing, verdict);
  check_table(options.table, verdict);
  check_hand(options.hand, verdict);
  check_bench_sensor(options.sensor, verdict);
  check_supply(options, verdict);
  if (options.procedure == Procedure::slide) check_slide(options, verdict);
  const ProcedureTiming& timing = options.timing;
  const double rest_s = timing.dwell_s * (1.0 - timing.dwell_jitter) - timing.settle_s;
  verdict.require(rest_s * options.rate_hz >= 2.0, "dwell_s",
                  "must leave at least two samples of rest in each position");
  if (!verdict.status()) return verdict.status();
  const std::vector<PlannedPose> plan = plan_poses(options);
  verdict.require(plan.back().end_s * options.rate_hz <= 1e8, "dwell_s",
                  "of all positions must hold at most 1e8 samples at that rate");
  verdict.require(options.hand.bad_pose <= static_cast<int>(plan.size()), "bad_pose",
                  "must be one of the positions");
  return verdict.status();
}

}  // namespace proofmass::simulate
