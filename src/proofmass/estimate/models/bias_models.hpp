#pragma once

#include "proofmass/estimate/filter/linear_gaussian.hpp"
#include "proofmass/sensor/warm_up.hpp"

// Bias of a sensor as a state of any linear model, driven by the warm-up of its sensor file.
namespace proofmass::estimate {

struct BiasOptions {
  double dt_s;             ///< time between samples, not negative
  double time_constant_s;  ///< T of the sensor's warm-up, positive
  double bias_psd_m2ps5;   ///< two-sided density of the white noise that drives the bias, ≥ 0
};

/// One step of a bias ε that settles exponentially at a known level u, exactly for any dt:
///
///     ε[k] = φ ε[k−1] + (1 − φ) u[k] + w,   φ = e^(−dt/T),   w ~ N(0, q T/2 (1 − φ²)).
///
/// Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications (2001), section 4.3, for the
/// exact discretisation of a first-order system with known input.
struct BiasStep {
  double phi;
  double settled;  ///< 1 − φ, factor of the known input
  double variance_m2ps4;
};
[[nodiscard]] BiasStep bias_step(const BiasOptions& options);

struct RandomWalkOptions {
  double dt_s = 0.0;            ///< time between samples, not negative
  double bias_psd_m2ps5 = 0.0;  ///< two-sided density of the white noise that drives the walk, ≥ 0
};

/// One step of a bias that is a pure random walk, the limit T → ∞: φ = 1, w ~ N(0, q dt).
[[nodiscard]] BiasStep random_walk_step(const RandomWalkOptions& options);

struct GaussMarkovOptions {
  double dt_s = 0.0;             ///< time between samples, not negative
  double time_constant_s = 0.0;  ///< T, positive
  double bias_std_mps2 = 0.0;    ///< standard deviation of the stationary process, ≥ 0
};

/// One step of a stationary Gauss–Markov bias about the level u with standard deviation σ: φ =
/// e^(−dt/T), w ~ N(0, σ² (1 − φ²)), which is BiasStep with q = 2σ²/T.
[[nodiscard]] BiasStep gauss_markov_step(const GaussMarkovOptions& options);

/// Prior of the bias at a time after power-on, before any measurement. The mean is the warm-up's
/// b(t); `ε(0) = a2` with the input `u = a1 + a2` (WarmUp::settled_mps2()) follows it. If a
/// calibration of the warmed-up sensor is applied, pass the warm-up's departure().
[[nodiscard]] Gaussian<1> bias_prior(const sensor::WarmUp& warm_up, double since_switch_on_s);

/// The model extended by one state, a bias, and one known input, the level to which the bias
/// settles; both come last. `read_by` is the sensitivity of each channel to the bias: 1 if it adds
/// to the channel, 0 if not. For several biases, call repeatedly.
template <int N, int M, int U>
[[nodiscard]] LinearModel<N + 1, M, U + 1> with_bias(const LinearModel<N, M, U>& model,
                                                     const BiasStep& step,
                                                     const Mat<M>& read_by) {
  LinearModel<N + 1, M, U + 1> out;
  out.F.setZero();
  out.Q.setZero();
  out.F.template topLeftCorner<N, N>() = model.F;
  out.Q.template topLeftCorner<N, N>() = model.Q;
  out.F(N, N) = step.phi;
  out.Q(N, N) = step.variance_m2ps4;
  out.H.template leftCols<N>() = model.H;
  out.H.col(N) = read_by;
  out.R = model.R;
  if constexpr (U > 0) out.B.template topLeftCorner<N, U>() = model.B;
  out.B(N, U) = step.settled;
  return out;
}

struct RestOptions {
  BiasOptions bias;
  double accel_variance_m2ps4;  ///< variance of one measurement
};

/// The bias alone, as measured by a sensor at rest: z = ε + v.
[[nodiscard]] LinearModel<1, 1, 1> bias_model(const RestOptions& options);

extern template LinearRun<1, 1> filter_linear(LinearSeries<1, 1, 1>,
                                              const Start<1>&,
                                              const LinearOptions&);
extern template LinearRun<1, 1> smooth_linear(LinearSeries<1, 1, 1>,
                                              const Start<1>&,
                                              const LinearOptions&);

}  // namespace proofmass::estimate
