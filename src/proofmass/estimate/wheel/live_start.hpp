#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/live_wheel.hpp"
#include "proofmass/estimate/wheel/likelihood.hpp"
#include "proofmass/estimate/wheel/live_epochs.hpp"
#include "proofmass/estimate/wheel/plane.hpp"

// Initialisation of a wheel from the first seconds.
namespace proofmass::estimate {

/// Place of a sensor's gyroscope among an epoch's vectors: after those of the accelerometers.
[[nodiscard]] std::optional<std::size_t> gyroscope_at(const LiveWheelOptions& options,
                                                      std::size_t sensor);

/// Initial values of the online filter.
struct LiveWheelStart {
  std::vector<WheelPlane> planes;  ///< of each sensor
  double rate_hz = 0.0;            ///< of the epochs
  double gravity_mps2 = standard_gravity_mps2, rolling_radius_m = 0.0, phase_rad = 0.0;
  Uncertain delay_s{};  ///< of the sensors' filters
  WheelNoise noise;
  std::array<double, 2> variance_m2ps4{};  ///< of a measurement of each sensor, at the epochs' rate
  /// The same of its gyroscope, rad²/s²; 0 without one.
  std::array<double, 2> speed_variance{};
  std::array<double, 2> speed_scatter2{};  ///< of neighbouring ones
  std::array<RateLeak, 2> leak_u{}, leak_v{};
  WheelPrior prior;  ///< of the state at the first epoch
  /// Covariance of `constants`, the lever arms included; empty if the hub vibrates: vibration
  /// biases constants that were fitted to a few seconds.
  Eigen::MatrixXd constants_cov;
  Eigen::VectorXd constants;  ///< initial linearisation point
  Eigen::MatrixXd places_cov;
  RippleOrders orders = first_orders;
  bool with_ripple = false;  ///< `constants` include it: not if the hub vibrates
  bool whole_turn = false;   ///< else the constants come from the prior rather than the data
  std::vector<Note> notes;
};

/// Initialisation by estimate_wheel()'s methods. Errors: as for estimate_wheel().
[[nodiscard]] Result<LiveWheelStart> find_wheel(const std::vector<LiveEpoch>& epochs,
                                                const LiveWheelOptions& options);

}  // namespace proofmass::estimate
