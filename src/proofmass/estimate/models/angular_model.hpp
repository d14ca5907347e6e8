#pragma once

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/models/bias_models.hpp"

// Motion about one axis.
namespace proofmass::estimate {

/// Indices of each quantity in the state and in the measurement of angular_model().
namespace angular {
inline constexpr int angle_rad = 0;
inline constexpr int rate_radps = 1;
inline constexpr int accel_radps2 = 2;
inline constexpr int bias_radps2 = 3;

inline constexpr int accel_channel = 0;  ///< α + b, from two opposite accelerometers
inline constexpr int rate_channel = 1;   ///< ω, from a bias-compensated gyroscope
inline constexpr int angle_channel = 2;  ///< θ, from gravity or an encoder
}  // namespace angular

struct AngularOptions {
  double dt_s = 0.0;                  ///< time between samples, not negative
  double jerk_psd_rad2ps5 = 0.0;      ///< two-sided density of the white noise that drives α
  double bias_time_constant_s = 0.0;  ///< time constant of the settling bias; 0: random walk
  double bias_psd_rad2ps5 = 0.0;      ///< density of the white noise that drives the bias
  double accel_variance_rad2ps4 = 0.0;
  double rate_variance_rad2ps2 = 1.0;
  double angle_variance_rad2 = 1.0;
};

/// Angle, rate and acceleration about one axis, and the bias of the measured acceleration:
///
///     θ' = ω,  ω' = α,  α' = w,   z = (α + b, ω, θ).
///
/// A missing channel is NaN in each epoch. The known input is the level to which the bias settles.
/// From α alone angle and rate are not observable; with the rate, α and b are separable. Source: M.
/// A. Lele (2010), section 4.4, with H for the channels above. Exact for any dt.
[[nodiscard]] LinearModel<4, 3, 1> angular_model(const AngularOptions& options);

/// Tangential measurements of two accelerometers on opposite ends of a diameter, axes parallel.
struct OppositePair {
  double first_mps2 = 0.0, second_mps2 = 0.0;
  double variance_m2ps4 = 0.0;  ///< variance of one measurement
  double radius_m = 0.0;        ///< distance of each from the axis, positive
};

/// α = (f_t1 − f_t2)/(2R), free of gravity, and its standard deviation σ/(√2 R). (The thesis
/// multiplies by the radius.)
[[nodiscard]] Uncertain angular_accel(const OppositePair& pair);

struct TiltRateOptions {
  double dt_s = 0.0;
  double rate_psd_rad2ps = 0.0;      ///< two-sided density of the gyroscope's white noise
  double bias_psd_rad2ps3 = 0.0;     ///< density of the white noise that drives its bias
  double angle_variance_rad2 = 0.0;  ///< variance of one accelerometer-derived angle
};

/// Tilt about one axis and the gyroscope's bias, with the gyroscope's measurement as known input u:
///
///     θ[k] = θ[k−1] + (u − b) dt + w,   z = θ + v.
///
/// Exact for any dt over which u is constant: the random walk of the bias enters the angle through
/// Q = ∫ e^(As) diag(N², K²) e^(Aᵀs) ds.
[[nodiscard]] LinearModel<2, 1, 1> tilt_rate_model(const TiltRateOptions& options);

extern template LinearRun<4, 3> filter_linear(LinearSeries<4, 3, 1>,
                                              const Start<4>&,
                                              const LinearOptions&);
extern template LinearRun<4, 3> smooth_linear(LinearSeries<4, 3, 1>,
                                              const Start<4>&,
                                              const LinearOptions&);
extern template LinearRun<2, 1> filter_linear(LinearSeries<2, 1, 1>,
                                              const Start<2>&,
                                              const LinearOptions&);
extern template LinearRun<2, 1> smooth_linear(LinearSeries<2, 1, 1>,
                                              const Start<2>&,
                                              const LinearOptions&);

}  // namespace proofmass::estimate
