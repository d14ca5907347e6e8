#pragma once

#include <vector>

#include "proofmass/thesis/first_turn.hpp"
#include "proofmass/thesis/wheel_rig.hpp"

// One run of the wheel's model over a simulated record, for the many that stand behind a band.
namespace proofmass::thesis {

/// The angle through the whole record by the filter and smoother of estimate/wheel_model.hpp, told
/// that the wheel starts at rest and nothing of its sensors' errors: what estimate_wheel() finds
/// after many passes, in three. The noise, which it would find too, is taken from the rig: readings
/// by the datasheet, jerk by the two ends of the ramp, snap by the ripple, the biases' walk by the
/// warm-up; so is the delay of the sensors' filters. The filter is the live one: each epoch knows
/// only what came before it. Readings are averaged two by two. Expects a record of
/// simulate_wheel(run).
struct WheelPass {
  std::vector<double> time_s;
  AngleEstimate filtered, smoothed;
  std::vector<double> moved_std_rad;  ///< of the smoothed angle less that at the first epoch
  std::vector<double> smoothed_accel_radps2;
};
[[nodiscard]] WheelPass wheel_pass(const RigRun& run, const WheelRecord& record);

}  // namespace proofmass::thesis
