#pragma once

#include "proofmass/estimate/filter/linear_gaussian.hpp"

// Motion along one axis, measured by an accelerometer.
namespace proofmass::estimate {

/// Indices of each quantity in the state of a PVA model: x.mean[pva::velocity_mps].
namespace pva {
inline constexpr int position_m = 0;
inline constexpr int velocity_mps = 1;
inline constexpr int accel_mps2 = 2;
inline constexpr int bias_mps2 = 3;  ///< in pva_bias_model() only
}  // namespace pva

struct PvaOptions {
  double dt_s;                  ///< time between samples, not negative
  double jerk_psd_m2ps5;        ///< two-sided density of the white jerk that drives the model
  double accel_variance_m2ps4;  ///< variance of one accelerometer measurement
};

/// Position, velocity and acceleration along one axis, driven by white jerk; an accelerometer
/// measures the acceleration. Exact discretisation, for any dt. Source: Bar-Shalom, Li,
/// Kirubarajan, Estimation with Applications (2001), section 6.2.3.
[[nodiscard]] LinearModel<3, 1> pva_model(const PvaOptions& options);

struct SingerOptions {
  double dt_s = 0.0;                  ///< time between samples, not negative
  double maneuver_time_s = 0.0;       ///< τ, correlation time of the acceleration, positive
  double maneuver_std_mps2 = 0.0;     ///< σ, stationary standard deviation of the acceleration, ≥ 0
  double accel_variance_m2ps4 = 0.0;  ///< variance of one accelerometer measurement
};

/// Position, velocity and a Gauss–Markov acceleration:
///
///     a' = −a/τ + w,   E w w = 2σ²/τ δ(t),   z = a + v.
///
/// Unlike pva_model(), whose acceleration is an unbounded random walk, the acceleration has a
/// stationary variance; for dt ≪ τ the two models agree, with the jerk density 2σ²/τ. Exact
/// discretisation, for any dt. Source: R. A. Singer, Estimating optimal tracking filter performance
/// for manned maneuvering targets, IEEE Trans. AES 6 (1970) 473, equation 8 for F; Q is the
/// integral of his equation 10, without the cancellation of its closed form.
[[nodiscard]] LinearModel<3, 1> singer_model(const SingerOptions& options);

struct PvaBiasOptions {
  PvaOptions motion;
  double time_constant_s;  ///< T of the sensor's warm-up, positive
  double bias_psd_m2ps5;   ///< two-sided density of the white noise that drives the bias, ≥ 0
};

/// pva_model() with the sensor's bias ε, which settles exponentially after power-on:
///   ε[k] = φ ε[k−1] + (1 − φ)(a₁ + a₂),   φ = exp(−dt/T),   z = a + ε + v.
/// The known input u of each epoch is the level to which the bias settles, a₁ + a₂ in m/s²; ε(0) =
/// a₂ gives the fitted warm-up a₁(1 − exp(−t/T)) + a₂. From accelerations alone position and
/// velocity are not observable; the prior, or measurements of them, must determine their initial
/// values. Source: M. A. Lele (2010), section 4.3; the discretisation of the bias is that of an
/// Ornstein–Uhlenbeck process, exact for any dt.
[[nodiscard]] LinearModel<4, 1, 1> pva_bias_model(const PvaBiasOptions& options);

extern template LinearRun<3, 1> filter_linear(LinearSeries<3, 1>,
                                              const Start<3>&,
                                              const LinearOptions&);
extern template LinearRun<3, 1> smooth_linear(LinearSeries<3, 1>,
                                              const Start<3>&,
                                              const LinearOptions&);
extern template LinearRun<4, 1> filter_linear(LinearSeries<4, 1, 1>,
                                              const Start<4>&,
                                              const LinearOptions&);
extern template LinearRun<4, 1> smooth_linear(LinearSeries<4, 1, 1>,
                                              const Start<4>&,
                                              const LinearOptions&);

}  // namespace proofmass::estimate
