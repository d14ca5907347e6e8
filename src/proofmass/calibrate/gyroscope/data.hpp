#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/gyroscope/motion.hpp"
#include "proofmass/calibrate/slow_noise.hpp"

// The rests, motions and turntable rates of all sessions, as the fit needs them.
namespace proofmass::calibrate {

/// Rate of Earth's rotation relative to the stars. Source: IERS Conventions (2010), table 1.1.
inline constexpr double earth_rate_radps = 7.292115e-5;

struct GyroscopeRest {
  Eigen::Vector3d up, force;  ///< unit vector; m/s^2
  /// Covariance of the rotation vector by which `up` is wrong, due to noise.
  Eigen::Matrix3d tilt_covariance;
  /// That rotation vector per parameter of the accelerometer's calibration.
  Eigen::Matrix<double, 3, 9> tilt_by_accel;
  Eigen::Vector3d mean, variance;  ///< of the gyroscope
  Eigen::Vector3d rounding;        ///< the part of `variance` due to quantisation
  std::size_t session = 0;
  Span span_s{};  ///< in the session's time
};

struct GyroscopeMotion {
  MotionSamples samples;
  std::size_t from = 0, to = 0;  ///< index of the rests
  Eigen::Vector3d noise_axes;    ///< N² of each axis over the motion's duration, reading²·s
};

struct GyroscopeRate {
  Eigen::Vector3d mean, variance, force;  ///< of the gyroscope; of the accelerometer
  double rate_radps, std_radps;
};

struct GyroscopeData {
  std::vector<GyroscopeRest> rests;
  std::vector<GyroscopeMotion> motions;  ///< those with all samples
  std::vector<std::size_t> listed;       ///< index of each into `residuals`
  std::vector<MotionResidual>
      residuals;  ///< one for each motion of the recordings, to be filled in
  std::vector<GyroscopeRate> rates;
  double noise_dof = 0.0;  ///< of the common factor of all variances; 0: unknown
  Eigen::Vector3d white = Eigen::Vector3d::Zero();  ///< N² of one sample times dt, reading²·s
};

/// Errors: those of calibrate_gyroscope() that concern the input.
[[nodiscard]] Result<GyroscopeData> gyroscope_data(View<GyroscopeSession> sessions,
                                                   const MultiPosition& accelerometer,
                                                   View<TurntableRate> table);

}  // namespace proofmass::calibrate
