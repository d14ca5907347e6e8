#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/states.hpp"

// The measurements of a wheel's sensors and encoder as the filter takes them.
namespace proofmass::estimate {

/// What a gyroscope's axis in the plane of the wheel measures without a turning vehicle: its bias,
/// and a share of the speed if the axes are not exactly perpendicular to the axle.
struct RateLeak {
  double bias_radps = 0.0, share = 0.0;

  [[nodiscard]] double at(double speed_radps) const { return bias_radps + share * speed_radps; }
};

/// Measurements of one sensor in the plane of the wheel, SI.
struct PlanarReadings {
  std::vector<double> u_mps2, v_mps2;  ///< NaN where missing
  std::vector<double> variance_m2ps4;  ///< of each measurement, both axes alike
  /// Gyroscope rate about the axle, NaN where missing; empty without one that measures.
  std::vector<double> speed_radps{};
  double speed_variance = 0.0;  ///< variance of each, rad²/s², with what the model leaves
  double speed_scatter2 = 0.0;  ///< variance by neighbouring measurements: the gyroscope's noise
  /// Its rates along u and v less their leaks, as long: a turning vehicle's. NaN as above.
  std::vector<double> rate_u_radps{}, rate_v_radps{};
  RateLeak leak_u{}, leak_v{};
  double axle_slope = 0.0;  ///< tangent of the axle's inclination as the accelerometer shows it
  bool constant_gyroscope = false;  ///< its output does not change: not used

  [[nodiscard]] bool has(std::size_t row) const {
    return !std::isnan(u_mps2[row]) && !std::isnan(v_mps2[row]);
  }
};

/// (c, s) of each order of an encoder's errors, rad.
using EncoderErrors = std::array<Uncertain, wheel::encoder_states - 1>;
/// Without a calibration: the disc may be off centre by a twentieth of its radius.
inline constexpr EncoderErrors uncalibrated_errors_rad{
    Uncertain{0.0, 0.05}, {0.0, 0.05}, {0.0, 0.05}, {0.0, 0.05}};

/// Estimated variance of an encoder's fixes beyond that of the counts.
struct FixNoise {
  double constant_rad2 = 0.0;  ///< such as errors of higher order
  double stamps_s2 = 0.0;      ///< of the time stamps

  [[nodiscard]] double variance_rad2(double speed_radps) const {
    return constant_rad2 + square(speed_radps) * stamps_s2;
  }
};

/// An encoder's angle at each epoch: the mean of its fixes since the epoch before.
struct EncoderReadings {
  std::vector<double> angle_rad;      ///< its own, unwrapped; NaN without a fix
  std::vector<double> age_s;          ///< the epoch's time less the fixes'
  std::vector<double> variance_rad2;  ///< of the fixes, from the counts' width
  double step_rad = 0.0;              ///< width of a count; 0: no visible steps
  FixNoise more{};
  double direction = 1.0;  ///< d
  double zero_rad = 0.0;   ///< current estimate of o; its state is the difference
  double walk_psd = 0.0;   ///< random walk of o, rad²/s, for single missed counts
  EncoderErrors errors_rad = uncalibrated_errors_rad;  ///< prior
  double nonlinearity = 0.0;  ///< standard deviation of the accelerometers', at 1 g

  [[nodiscard]] bool has(std::size_t k) const { return !std::isnan(angle_rad[k]); }
};

/// One epoch of the merged time line and the row of each sensor measured then.
struct WheelEpoch {
  static constexpr std::int64_t no_row = -1;
  double dt_s = 0.0;  ///< since the previous epoch
  std::array<std::int64_t, 2> row{no_row, no_row};
  /// Wheel static: the measurements around keep their values, see mark_standing().
  bool stands = false;
  /// White jerk since the previous epoch beyond that of the noise parameters, rad²/s⁵, see
  /// mark_jerks().
  double jerk_psd = 0.0;
  /// Variance of the times of the measurements averaged in this epoch.
  double spread_s2 = 0.0;
};

}  // namespace proofmass::estimate
