#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "proofmass/estimate/dense_kernels.hpp"
#include "proofmass/estimate/gaussian.hpp"

// The one Kalman filter under every model of this module, linear or extended, with readings taken
// one channel at a time.
//
//   state     x[k] = f(x[k−1]) + w,   w ~ N(0, Q)     N-vector, of which the first D move
//   readings  z[k] = h(x[k]) + v,     v ~ N(0, R)     up to M scalars, R diagonal
//
// A channel without a reading is left out, so one dead channel costs nothing but itself. Constants
// and slow walks stand behind the D moving states: a prediction then costs O(D N) instead of O(N³).
namespace proofmass::estimate {

/// One step of time: the predicted moving states, how they hang on the former ones, and the noise
/// that came in.
template <int N, int D>
struct Transition {
  Mat<D> mean;  ///< f(x) of the moving states
  Mat<D, D> F;  ///< ∂f/∂x among the moving states; the others neither move nor push
  Mat<D, D> Q;  ///< process noise of the moving states
  Mat<N> walk;  ///< variance added to each standing state; its first D are not read
};

/// One channel's reading and what the model makes of it at the predicted state.
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
  /// count of rejected instants.
  int constraints = 0;
};

/// What a model offers: sizes, the step that leads to instant k, and the readings of instant k.
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

/// How many of a model's states the filter runs on: all, unless the model says by active() that
/// those from there on are held, without variance.
template <StateSpaceModel Model>
[[nodiscard]] int active_states(const Model& model) {
  if constexpr (requires { model.active(); })
    return model.active();
  else
    return Model::states;
}

/// What one channel's reading did to the state: all that the backward pass and the tests need.
template <int N>
struct Update {
  Mat<N> h, gain;
  double innovation = 0.0;  ///< y = z − h(x̂)
  double expected = 0.0;    ///< S = h P hᵀ + R, with the R that the model states
  double variance = 0.0;    ///< S as used: larger where the reading lost weight
  bool used = false;        ///< false: passed the gate's limit and was left out
  [[nodiscard]] double nis() const { return innovation * innovation / expected; }
};

/// What is done with readings that the model did not expect, ν = |y|/√S standard deviations off.
/// Beyond `huber` they lose weight as huber/ν, so that none pulls harder than one just there;
/// beyond `limit` they are left out. After `patience` instants in a row with nothing but such
/// readings the filter has lost the state, not the sensor its mind: the model reopens the
/// covariance and what comes is believed again. Source: P. J. Huber, Robust Statistics (1981),
/// section 4.5.
struct Gate {
  double huber = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::infinity();
  int patience = 25;
};

template <int N>
struct FilterState {
  Gaussian<N> x;
  int instants_gated = 0;  ///< in a row, up to now
};

/// x̂[k|k−1] from x̂[k−1|k−1].
template <int N, int D>
void predict(Gaussian<N>& x, const Transition<N, D>& step) {
  x.mean.template head<D>() = step.mean;
  const Mat<D, N> FP = step.F.lazyProduct(x.cov.template topRows<D>());
  // Symmetric to the last bit: corrections do not reach what is not, and F would make it grow.
  const Mat<D, D> FPF = FP.template leftCols<D>() * step.F.transpose();
  x.cov.template topLeftCorner<D, D>() = 0.5 * (FPF + FPF.transpose()) + step.Q;
  if constexpr (D < N) {
    constexpr int S = N - D;
    x.cov.template topRightCorner<D, S>() = FP.template rightCols<S>();
    x.cov.template bottomLeftCorner<S, D>() = FP.template rightCols<S>().transpose();
    x.cov.diagonal().template tail<S>() += step.walk.template tail<S>();
  }
}

/// x̂ given one more reading: Kalman's gain, and P ← P − (P hᵀ)(P hᵀ)ᵀ / S, of which an entry and
/// its mirror round alike; Joseph's form instead, in O(N³), where the start is diffuse. Cost:
/// O(N²). `predicted` is h(x̂) at the state as it stands. States from `active` on are held: their
/// variances and covariances are zero, and are not touched. Source: G. J. Bierman, Factorization
/// Methods for Discrete Sequential Estimation (1977), section II.
template <int N>
[[nodiscard]] Update<N> correct(Gaussian<N>& x,
                                const Reading<N>& reading,
                                const Gate& gate,
                                int active = N) {
  Mat<N> Ph = Mat<N>::Zero();
  symmetric_times(x.cov.data(), reading.h.data(), Ph.data(), {active, N});
  Update<N> update;
  update.h = reading.h;
  update.innovation = reading.value - reading.predicted;
  const double hPh = reading.h.dot(Ph);
  update.expected = update.variance = hPh + reading.variance;
  const double off = std::abs(update.innovation) / std::sqrt(update.expected);
  update.used = off <= gate.limit;
  if (!update.used) {
    update.gain.setZero();
    return update;
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
  return update;
}

/// One instant of a run: the state after its readings, and what led there.
template <int N, int D, int M>
struct Step {
  Mat<D, D> F;  ///< of the transition to this instant; identity at the first
  std::array<Update<N>, static_cast<std::size_t>(M)> updates;
  int count = 0;
  Gaussian<N> filtered;
};

template <StateSpaceModel Model>
using StepOf = Step<Model::states, Model::moving, Model::channels>;

/// Takes the state from instant k − 1 to k (at k = 0: only its readings) and says how in `step`.
template <StateSpaceModel Model>
void advance(const Model& model,
             std::size_t k,
             const Gate& gate,
             FilterState<Model::states>& state,
             StepOf<Model>& step) {
  constexpr int N = Model::states;
  if (k > 0) {
    const auto transition = model.transition(state.x.mean, k);
    step.F = transition.F;
    predict(state.x, transition);
  } else {
    step.F.setIdentity();
  }
  if (state.instants_gated >= gate.patience) {
    model.reopen(state.x, k);
    state.instants_gated = 0;
  }
  Readings<N, Model::channels> readings;
  const Mat<N> linearised_at = state.x.mean;
  model.measure(linearised_at, k, readings);
  bool any_used = false;
  for (int i = 0; i < readings.count; ++i) {
    Reading<N>& reading = readings.rows[static_cast<std::size_t>(i)];
    reading.predicted += reading.h.dot(state.x.mean - linearised_at);
    const Update<N>& update = step.updates[static_cast<std::size_t>(i)] =
        correct(state.x, reading, gate, active_states(model));
    any_used = any_used || (update.used && i < readings.count - readings.constraints);
  }
  if (readings.count > 0) state.instants_gated = any_used ? 0 : state.instants_gated + 1;
  step.count = readings.count;
  step.filtered = state.x;
}

/// Filters instants [first, last) from `state`, telling each to visit(k, step).
template <StateSpaceModel Model, class Visit>
void filter(const Model& model,
            std::size_t first,
            std::size_t last,
            const Gate& gate,
            FilterState<Model::states>& state,
            Visit&& visit) {
  StepOf<Model> step;
  for (std::size_t k = first; k < last; ++k) {
    advance(model, k, gate, state, step);
    visit(k, std::as_const(step));
  }
}

}  // namespace proofmass::estimate
