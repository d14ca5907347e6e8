#pragma once

#include <vector>

#include "proofmass/thesis/wheel/first_turn.hpp"
#include "proofmass/thesis/wheel/rig.hpp"

// One run of the wheel's model over a simulated record, for the many runs of a band.
namespace proofmass::thesis {

/// The angle through the whole record by the filter and smoother of estimate/wheel/model.hpp, with
/// a start at rest and unknown sensor errors: the result of estimate_wheel()'s many passes in
/// three.
///
/// - The noise comes from the rig instead of an estimate: measurement noise from the datasheet,
///   jerk from the two ends of the ramp, snap from the ripple, the biases' random walk from the
///   warm-up; so does the delay of the sensors' filters.
/// - The filter is causal: each epoch uses only earlier data. Measurements are averaged in pairs.
///
/// Expects a record of simulate_wheel(run).
struct WheelPass {
  std::vector<double> time_s;
  AngleEstimate filtered, smoothed;
  std::vector<double> moved_std_rad;  ///< of the smoothed angle less that at the first epoch
  std::vector<double> smoothed_accel_radps2;
};
[[nodiscard]] WheelPass wheel_pass(const RigRun& run, const WheelRecord& record);

}  // namespace proofmass::thesis
