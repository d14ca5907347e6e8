#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::simulate {

/// One sensor of the rig with all values drawn for it from the seed.
struct SensorTwin {
  SensorTwin(const RigOptions& options, std::size_t index);

  /// Fraction of the warm-up reached: 0 at the start, 1 at the end.
  [[nodiscard]] double warm_up(double t_s) const;

  RigSensor sensor;            ///< the given one with the draws added
  Eigen::Vector3d position_m;  ///< in the wheel's axes
  Eigen::Matrix3d R_sensor_wheel;
  Eigen::Matrix3d M;  ///< (I + C) diag(scale) T⁻¹
  double alignment_std_rad = 0.0;
};

/// One axis of a sensor from sample to sample: its bias, noise and filter.
class AxisTwin {
 public:
  AxisTwin(const SensorTwin& twin, const RigOptions& options, std::size_t sensor, std::size_t axis);

  /// Bias with this fraction of the warm-up, and with the random walk, in m/s².
  [[nodiscard]] double bias_mps2(double warm_up) const;
  /// Reading of the force along u = M f, in m/s², without noise, clipped at full scale.
  [[nodiscard]] double reading_mps2(double u_mps2, double warm_up) const;
  /// Noise of the next sample, in m/s².
  [[nodiscard]] double next_noise_mps2();
  void step_walk();

 private:
  const RigSensor* sensor_;
  std::size_t axis_;
  double walk_step_mps2_;  ///< rms of the walk per sample
  double walk_mps2_ = 0.0;
  double filtered_rms_;
  double filtered_mps2_ = 0.0;  ///< noise after the RC filter
  double memory_ = 0.0;         ///< e^(−2π bandwidth · step), pole of the filter
  double renewed_mps2_ = 0.0;   ///< rms of the new part per sample
  Random white_, density_, walk_;
};

/// A one-pole low-pass, exact for an input that is linear between the given times.
class OnePole {
 public:
  explicit OnePole(double bandwidth_hz);
  /// The output at t_s; the first call initialises it to its input.
  double next(double t_s, double input);

 private:
  double tau_s_;
  bool started_ = false;
  double t_s_ = 0.0, input_ = 0.0, output_ = 0.0;
};

/// The sensor model after a perfect calibration of the warmed-up sensor and a perfect static bias
/// test; see RigResult::sensors.
[[nodiscard]] sensor::SensorModel model_of(const SensorTwin& twin,
                                           const RigOptions& options,
                                           std::size_t index);

/// Bias, scale and misalignment of a sensor with the output M f + bias, as a calibration against
/// gravity would find them.
[[nodiscard]] sensor::Calibration calibration_of(const Eigen::Matrix3d& M, const Axes& bias_mps2);

/// Angle of the rotation in M that is not observable in such a calibration.
[[nodiscard]] double unseen_turn_rad(const Eigen::Matrix3d& M);

}  // namespace proofmass::simulate
