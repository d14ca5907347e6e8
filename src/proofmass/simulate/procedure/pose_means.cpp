#include <algorithm>
#include <cmath>
#include <string>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/procedure.hpp"
#include "proofmass/simulate/procedure/pose_plan.hpp"
#include "proofmass/simulate/procedure/sensor_error_model.hpp"

namespace proofmass::simulate {
namespace {

/// Samples k with start <= k/rate < end.
std::size_t samples_within(const TruePose& pose, double rate_hz) {
  const double first = std::ceil(pose.start_s * rate_hz), end = std::ceil(pose.end_s * rate_hz);
  return static_cast<std::size_t>(std::max(0.0, end - first));
}

}  // namespace

Result<PoseMeans> draw_pose_means(const ProcedureOptions& options, std::size_t trial) {
  if (const Status checked = check(options); !checked) return checked.error();
  const SensorErrorModel sensor(options);
  PoseMeans drawn;
  drawn.truth.poses = true_poses(plan_poses(options));
  drawn.truth.equations = sensor.recorded_equations();
  drawn.truth.sensor = sensor.model();
  for (const TruePose& pose : drawn.truth.poses)
    drawn.means.push_back({.samples = samples_within(pose, options.rate_hz)});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    Random white(session_seed(options), "white noise of means", 3 * trial + axis);
    BenchDrift drift(options, axis, trial);
    double drift_sum = 0.0, samples = 0.0;
    for (std::size_t k = 0; k < drawn.means.size(); ++k) {
      const TruePose& pose = drawn.truth.poses[k];
      PoseMean& mean = drawn.means[k];
      const double n = static_cast<double>(mean.samples);
      const double mean_drift = drift.mean_over(pose.start_s, pose.end_s);
      const double white_std = options.sensor.noise_rms_mps2[axis] / std::sqrt(n);
      const double reading = sensor.reading_mps2(axis, {.force_mps2 = pose.force_mps2});
      mean.mean(i) = sensor.mean_recorded(axis, reading + mean_drift, white_std * white.normal());
      mean.white_std(i) = white_std * sensor.noise_gain();
      drift_sum += n * mean_drift;
      samples += n;
    }
    drawn.truth.mean_drift_mps2[axis] = drift_sum / samples;
  }
  return drawn;
}

}  // namespace proofmass::simulate
