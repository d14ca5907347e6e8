#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "proofmass/estimate/filter/dense_kernels.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"

// The Kalman filter under every model of this module, linear or extended, with measurements
// processed one channel at a time.
//
//   state         x[k] = f(x[k−1]) + w,   w ~ N(0, Q)     N-vector, the first D are dynamic
//   measurements  z[k] = h(x[k]) + v,     v ~ N(0, R)     up to M scalars, R diagonal
//
// A channel without a measurement is skipped, so a dead channel does not affect the others. Static
// states (constants and slow random walks) follow the D dynamic ones: a prediction then costs O(D
// N) instead of O(N³).
namespace proofmass::estimate {

/// One time step: the predicted dynamic states, their Jacobian, and the process noise.
template <int N, int D>
struct Transition {
  Mat<D> mean;  ///< f(x) of the dynamic states
  Mat<D, D> F;  ///< ∂f/∂x among the dynamic states; they do not depend on the static ones
  Mat<D, D> Q;  ///< process noise of the dynamic states
  Mat<N> walk;  ///< variance added to each static state; its first D entries are not used
};

/// One channel's measurement and its prediction from the state.
template <int N>
struct Reading {
  double value;      ///< z
  double predicted;  ///< h(x)
  double variance;   ///< R, positive
  Mat<N> h;          ///< ∂h/∂x
};

template <int N, int M>
struct Readings {
  std::array<Reading<N>, static_cast<std::size_t>(M)> rows;
  int count = 0;
  /// How many of the last rows are pseudo-measurements: accepting one does not reset the gate's
  /// count of rejected epochs.
  int constraints = 0;
};

/// Requirements of a model: sizes, the step that leads to epoch k, and the measurements of epoch k.
template <class Model>
concept StateSpaceModel = requires(const Model& model,
                                   const Mat<Model::states>& x,
                                   std::size_t k,
                                   Readings<Model::states, Model::channels>& readings,
                                   Gaussian<Model::states>& lost) {
  { model.size() } -> std::convertible_to<std::size_t>;
  { model.transition(x, k) } -> std::same_as<Transition<Model::states, Model::moving>>;
  model.measure(x, k, readings);
  model.reopen(lost, k);
};

/// Number of states that the filter estimates: all, unless the model's active() gives a count; the
/// states from there on are held constant, without variance.
template <StateSpaceModel Model>
[[nodiscard]] int active_states(const Model& model) {
  if constexpr (requires { model.active(); })
    return model.active();
  else
    return Model::states;
}

/// Effect of one measurement on the state: all that the backward pass and the tests need.
template <int N>
struct Update {
  Mat<N> h, gain;
  double innovation = 0.0;  ///< y = z − h(x̂)
  double expected = 0.0;    ///< S = h P hᵀ + R, with the model's R
  double variance = 0.0;    ///< S as used: larger if the measurement was down-weighted
  bool used = false;        ///< false: rejected by the gate
  [[nodiscard]] double nis() const { return innovation * innovation / expected; }
};

/// Treatment of unexpected measurements, with ν = |y|/√S:
///
/// - beyond `huber` they are down-weighted by huber/ν, which bounds their influence;
/// - beyond `limit` they are rejected;
/// - after `patience` consecutive epochs with only rejected measurements, the filter is assumed to
///   have diverged: the model resets the covariance and measurements are accepted again.
///
/// Source: P. J. Huber, Robust Statistics (1981), section 4.5.
struct Gate {
  double huber = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::infinity();
  int patience = 25;
};

template <int N>
struct FilterState {
  Gaussian<N> x;
  int epochs_gated = 0;  ///< consecutive, up to now
};

/// x̂[k|k−1] from x̂[k−1|k−1]. States from `active` on are held, without covariances.
template <int N, int D>
void predict(Gaussian<N>& x, const Transition<N, D>& step, int active = N) {
  x.mean.template head<D>() = step.mean;
  Mat<D, N> FP;
  if constexpr (D == 4 && N > 12) {
    FP.setZero();
    four_by_four_times(step.F.data(), x.cov.data(), FP.data(), {active, N});
  } else {
    FP = step.F.lazyProduct(x.cov.template topRows<D>());
  }
  // Exactly symmetric: corrections do not reach the antisymmetric part, and F would make it grow.
  const Mat<D, D> FPF = FP.template leftCols<D>() * step.F.transpose();
  x.cov.template topLeftCorner<D, D>() = 0.5 * (FPF + FPF.transpose()) + step.Q;
  if constexpr (D < N) {
    constexpr int S = N - D;
    x.cov.template topRightCorner<D, S>() = FP.template rightCols<S>();
    x.cov.template bottomLeftCorner<S, D>() = FP.template rightCols<S>().transpose();
    x.cov.diagonal().template tail<S>() += step.walk.template tail<S>();
  }
}

/// x̂ updated by one measurement: the Kalman gain, and P ← P − (P hᵀ)(P hᵀ)ᵀ / S, which rounds an
/// entry and its mirror alike; with a diffuse start the Joseph form, in O(N³). Cost: O(N²).
/// `predicted` is h(x̂) at the current state. States from `active` on are held: their variances and
/// covariances are zero and are not changed. Source: G. J. Bierman, Factorization Methods for
/// Discrete Sequential Estimation (1977), section II.
template <int N>
void correct(
    Gaussian<N>& x, const Reading<N>& reading, const Gate& gate, int active, Update<N>& update) {
  Mat<N> Ph = Mat<N>::Zero();
  symmetric_times(x.cov.data(), reading.h.data(), Ph.data(), {active, N});
  update.h = reading.h;
  update.innovation = reading.value - reading.predicted;
  const double hPh = reading.h.dot(Ph);
  update.expected = update.variance = hPh + reading.variance;
  const double off = std::abs(update.innovation) / std::sqrt(update.expected);
  update.used = off <= gate.limit;
  if (!update.used) {
    update.gain.setZero();
    return;
  }
  if (off > gate.huber) update.variance *= off / gate.huber;
  const double weight = 1.0 / update.variance;
  update.gain = Ph * weight;
  x.mean += update.gain * update.innovation;
  if (const double noise = reading.variance + (update.variance - update.expected);
      hPh > 1e8 * noise) {
    joseph_update(x.cov.data(), reading.h.data(), update.gain.data(), noise, {N, N});
  } else {
    const Mat<N> w = Ph * std::sqrt(weight);
    subtract_square(x.cov.data(), w.data(), {active, N});
  }
}
template <int N>
[[nodiscard]] Update<N> correct(Gaussian<N>& x, const Reading<N>& reading, const Gate& gate) {
  Update<N> update;
  correct(x, reading, gate, N, update);
  return update;
}

/// One epoch of a run: the state after its measurements, and how it was obtained.
template <int N, int D, int M>
struct Step {
  Mat<D, D> F;  ///< of the transition to this epoch; identity at the first
  std::array<Update<N>, static_cast<std::size_t>(M)> updates;
  int count = 0;
  Gaussian<N> filtered;
};

template <StateSpaceModel Model>
using StepOf = Step<Model::states, Model::moving, Model::channels>;

/// A filter's state where it is kept.
template <int N>
struct FilterStateAt {
  Gaussian<N>& x;
  int& epochs_gated;
};

/// Propagates the state from epoch k − 1 to k (at k = 0: only its measurements) and records the
/// step but for its `filtered`, which may be the state's own.
template <StateSpaceModel Model>
void advance_in_place(const Model& model,
                      std::size_t k,
                      const Gate& gate,
                      FilterStateAt<Model::states> state,
                      StepOf<Model>& step) {
  constexpr int N = Model::states;
  auto& [x, epochs_gated] = state;
  const int active = active_states(model);
  if (k > 0) {
    const auto transition = model.transition(x.mean, k);
    step.F = transition.F;
    predict(x, transition, active);
  } else {
    step.F.setIdentity();
  }
  if (epochs_gated >= gate.patience) {
    model.reopen(x, k);
    epochs_gated = 0;
  }
  Readings<N, Model::channels> readings;
  const Mat<N> linearised_at = x.mean;
  model.measure(linearised_at, k, readings);
  bool any_used = false;
  for (int i = 0; i < readings.count; ++i) {
    Reading<N>& reading = readings.rows[static_cast<std::size_t>(i)];
    reading.predicted += reading.h.dot(x.mean - linearised_at);
    Update<N>& update = step.updates[static_cast<std::size_t>(i)];
    correct(x, reading, gate, active, update);
    any_used = any_used || (update.used && i < readings.count - readings.constraints);
  }
  if (readings.count > 0) epochs_gated = any_used ? 0 : epochs_gated + 1;
  step.count = readings.count;
}

/// Propagates the state from epoch k − 1 to k and records the step.
template <StateSpaceModel Model>
void advance(const Model& model,
             std::size_t k,
             const Gate& gate,
             FilterState<Model::states>& state,
             StepOf<Model>& step) {
  constexpr int N = Model::states;
  advance_in_place(model, k, gate, {state.x, state.epochs_gated}, step);
  step.filtered.mean = state.x.mean;
  if constexpr (N > 12)
    copy_entries(state.x.cov.data(), step.filtered.cov.data(), N * N);
  else
    step.filtered.cov = state.x.cov;
}

/// Epochs first to last − 1.
struct EpochRange {
  std::size_t first = 0, last = 0;
};

/// Filters the epochs from `state`, which is set at the end, and calls visit(k, step) for each.
template <StateSpaceModel Model, class Visit>
void filter(const Model& model,
            EpochRange epochs,
            const Gate& gate,
            FilterState<Model::states>& state,
            Visit&& visit) {
  StepOf<Model> step;
  step.filtered = state.x;
  for (std::size_t k = epochs.first; k < epochs.last; ++k) {
    advance_in_place(model, k, gate, {step.filtered, state.epochs_gated}, step);
    visit(k, std::as_const(step));
  }
  state.x = step.filtered;
}

}  // namespace proofmass::estimate
