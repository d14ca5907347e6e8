#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::simulate {

/// One sensor of the rig with everything that the seed draws for it.
struct SensorTwin {
  SensorTwin(const RigOptions& options, std::size_t index);

  /// Share of the warm-up that is there: 0 at the first instant, 1 in the end.
  [[nodiscard]] double warm_up(double t_s) const;

  RigSensor sensor;            ///< the given one with the draws added
  Eigen::Vector3d position_m;  ///< in the wheel's axes
  Eigen::Matrix3d R_sensor_wheel;
  Eigen::Matrix3d M;  ///< (I + C) diag(scale) T⁻¹
  double alignment_std_rad = 0.0;
};

/// One axis of a sensor from sample to sample: what its bias does, its noise and its filter.
class AxisTwin {
 public:
  AxisTwin(const SensorTwin& twin, const RigOptions& options, std::size_t sensor, std::size_t axis);

  /// Bias with so large a share of the warm-up, and with the random walk, in m/s².
  [[nodiscard]] double bias_mps2(double warm_up) const;
  /// Reading of the force along u = M f, in m/s², without noise, clipped at full scale.
  [[nodiscard]] double reading_mps2(double u_mps2, double warm_up) const;
  /// Noise of the next sample, in m/s².
  [[nodiscard]] double next_noise_mps2();
  void step_walk();

 private:
  const RigSensor* sensor_;
  std::size_t axis_;
  double walk_step_mps2_;  ///< rms of the walk from sample to sample
  double walk_mps2_ = 0.0;
  double filtered_rms_;
  double filtered_mps2_ = 0.0;  ///< noise behind the RC filter
  double memory_ = 0.0;         ///< e^(−2π bandwidth · step), of the filter from sample to sample
  double renewed_mps2_ = 0.0;   ///< rms of what comes new into it with each
  Random white_, density_, walk_;
};

/// A one-pole low-pass, exact for an input that is linear between the times it is told.
class OnePole {
 public:
  explicit OnePole(double bandwidth_hz);
  /// The output at t_s; the first call settles it at its input.
  double next(double t_s, double input);

 private:
  double tau_s_;
  bool started_ = false;
  double t_s_ = 0.0, input_ = 0.0, output_ = 0.0;
};

/// What a bench would know of the sensor after a perfect calibration, done when it had warmed up,
/// and a perfect static bias test; see RigResult::sensors.
[[nodiscard]] sensor::SensorModel model_of(const SensorTwin& twin,
                                           const RigOptions& options,
                                           std::size_t index);

/// Bias, scale and misalignment of a sensor that reads M f + bias, as a calibration against gravity
/// would find them.
[[nodiscard]] sensor::Calibration calibration_of(const Eigen::Matrix3d& M, const Axes& bias_mps2);

/// Angle of the rotation in M that such a calibration cannot see.
[[nodiscard]] double unseen_turn_rad(const Eigen::Matrix3d& M);

}  // namespace proofmass::simulate
