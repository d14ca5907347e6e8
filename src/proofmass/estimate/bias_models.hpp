#pragma once

#include "proofmass/estimate/linear_gaussian.hpp"
#include "proofmass/sensor/warm_up.hpp"

// The bias of a sensor as a state of any linear model, driven by the warm-up of its sensor file.
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
  double settled;  ///< 1 − φ: what the known input is multiplied by
  double variance_m2ps4;
};
[[nodiscard]] BiasStep bias_step(const BiasOptions& options);

struct RandomWalkOptions {
  double dt_s = 0.0;            ///< time between samples, not negative
  double bias_psd_m2ps5 = 0.0;  ///< two-sided density of the white noise that drives the walk, ≥ 0
};

/// The same of a bias that walks and settles nowhere, the limit T → ∞: φ = 1, w ~ N(0, q dt).
[[nodiscard]] BiasStep random_walk_step(const RandomWalkOptions& options);

struct GaussMarkovOptions {
  double dt_s = 0.0;             ///< time between samples, not negative
  double time_constant_s = 0.0;  ///< T, positive
  double bias_std_mps2 = 0.0;    ///< standard deviation of the stationary process, ≥ 0
};

/// The same of a bias that wanders about the level u with a standard deviation σ that does not
/// change: φ = e^(−dt/T), w ~ N(0, σ² (1 − φ²)), which is the above with q = 2σ²/T.
[[nodiscard]] BiasStep gauss_markov_step(const GaussMarkovOptions& options);

/// What is known of the bias so long after switching on, before any reading: the mean is the
/// warm-up's b(t), and `ε(0) = a2` with the input `u = a1 + a2` (WarmUp::settled_mps2()) follows
/// it. Where a calibration of the warmed-up sensor is applied, the warm-up to give is its
/// departure().
[[nodiscard]] Gaussian<1> bias_prior(const sensor::WarmUp& warm_up, double since_switch_on_s);

/// The model with one state more, which is a bias, and one known input more, which is what the bias
/// settles at: both come last. `read_by` says how the bias enters each channel, 1 where it adds to
/// it, 0 where it does not. Several biases are several calls.
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
  double accel_variance_m2ps4;  ///< variance of one reading
};

/// The bias alone, as a sensor at rest reads it: z = ε + v.
[[nodiscard]] LinearModel<1, 1, 1> bias_model(const RestOptions& options);

extern template LinearRun<1, 1> filter_linear(LinearSeries<1, 1, 1>,
                                              const Start<1>&,
                                              const LinearOptions&);
extern template LinearRun<1, 1> smooth_linear(LinearSeries<1, 1, 1>,
                                              const Start<1>&,
                                              const LinearOptions&);

}  // namespace proofmass::estimate
