#pragma once

#include <array>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/live_instants.hpp"
#include "proofmass/estimate/live_wheel.hpp"
#include "proofmass/estimate/wheel_passes.hpp"
#include "proofmass/estimate/wheel_plane.hpp"

// What the first seconds tell of a wheel. Private to the module's live_wheel*.
namespace proofmass::estimate {

/// What the live filter starts with.
struct LiveWheelStart {
  std::vector<WheelPlane> planes;  ///< of each sensor
  double gravity_mps2 = standard_gravity_mps2, rolling_radius_m = 0.0, phase_rad = 0.0;
  Uncertain delay_s{};  ///< of the sensors' filters
  WheelNoise noise;
  std::array<double, 2> variance_m2ps4{};  ///< of a measurement of each sensor, at the epochs' rate
  WheelPrior prior;                        ///< of the state at the first epoch
  /// Covariance of `constants`, the places included; empty where the hub vibrates: vibration biases
  /// constants that were fitted to a few seconds.
  Eigen::MatrixXd constants_cov;
  Eigen::VectorXd constants;  ///< where to make the measurements linear about at first
  Eigen::MatrixXd places_cov;
  bool whole_turn = false;  ///< else the constants are believed more than shown
  std::vector<Note> notes;
};

/// As estimate_wheel() finds it. Errors: as of estimate_wheel().
[[nodiscard]] Result<LiveWheelStart> find_wheel(const std::vector<LiveInstant>& instants,
                                                const LiveWheelOptions& options);

}  // namespace proofmass::estimate
