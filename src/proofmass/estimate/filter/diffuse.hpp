#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/filter/start.hpp"

// Filter from a start x[0] = proper + A δ with δ entirely unknown. Three parts run together:
//
// - the ordinary filter, which assumes δ = 0;
// - the sensitivity X = ∂x̂/∂δ;
// - least squares for δ without a prior, in square-root information form.
//
// No large number is subtracted from another, and the result is exactly the limit κ → ∞ in Start.
// Source: P. de Jong, The diffuse Kalman filter, Annals of Statistics 19 (1991) 1073; G. J.
// Bierman, Factorization Methods for Discrete Sequential Estimation (1977), chapter V, for least
// squares.
namespace proofmass::estimate::detail {

/// Information on δ from the measurements so far, in coordinates Tᵀδ of which the first `found` are
/// determined: L (Tᵀδ)[0…found) = right + N(0, I), L lower triangular.
template <int N>
struct DiffuseKnowledge {
  Mat<N, N> turn = Mat<N, N>::Identity();  ///< T, orthogonal
  Mat<N, N> root = Mat<N, N>::Zero();      ///< L
  Mat<N> right = Mat<N>::Zero();
  int found = 0;
  int directions = 0;  ///< length of δ
};

template <int N>
struct DiffuseState {
  Gaussian<N> x;                        ///< given that δ = 0
  Mat<N, N> moved = Mat<N, N>::Zero();  ///< X; columns from `directions` on are zero
  DiffuseKnowledge<N> knowledge;
};

/// One epoch of a run.
template <int N, int M>
struct DiffuseStep {
  Step<N, N, M> step;  ///< step of the filter that assumes δ = 0
  Mat<N, N> moved;     ///< X after the measurements
  DiffuseKnowledge<N> knowledge;
  /// Innovation of each measurement in the complete filter and its variance; the variance is
  /// infinite if the measurement determined a direction, and F_inf = hᵀ P∞ h is then positive.
  std::array<double, static_cast<std::size_t>(M)> innovation, expected, F_inf;
};

/// Rotates the undetermined coordinates so that only the first of them affects a measurement with
/// sensitivity `seen` (in δ); returns that sensitivity.
template <int N>
double turn_to(DiffuseKnowledge<N>& known, const Mat<N>& seen) {
  Mat<N> v = Mat<N>::Zero();
  for (int j = known.found; j < known.directions; ++j) v(j) = known.turn.col(j).dot(seen);
  const double size = v.norm();
  const double first = v(known.found);
  v(known.found) += std::copysign(size, first);
  const Mat<N> Tv = known.turn * v;
  known.turn -= Tv * v.transpose() * (2.0 / v.squaredNorm());
  if (!std::signbit(first)) known.turn.col(known.found) *= -1.0;
  return size;
}

/// Rotates a row of least squares, `row` · Tᵀδ = right + N(0, 1), into L. The remainder of `right`
/// is the residual that the row adds, and `growth` = 1 + row (LᵀL)⁻¹ rowᵀ.
struct Residual {
  double value, growth;
};
template <int N>
Residual rotate_in(DiffuseKnowledge<N>& known, Mat<N> row, double right) {
  Residual residual{right, 1.0};
  for (int j = known.found; j-- > 0;) {
    const double pivot = known.root(j, j), size = std::hypot(pivot, row(j));
    const double c = pivot / size, s = row(j) / size;
    for (int i = 0; i <= j; ++i) {
      const double old = known.root(j, i);
      known.root(j, i) = c * old + s * row(i);
      row(i) = c * row(i) - s * old;
    }
    const double old = known.right(j);
    known.right(j) = c * old + s * residual.value;
    residual.value = c * residual.value - s * old;
    residual.growth *= (size / pivot) * (size / pivot);
  }
  return residual;
}

/// Estimate of Tᵀδ from the measurements; 0 where they contain no information.
template <int N>
[[nodiscard]] Mat<N> estimate_of(const DiffuseKnowledge<N>& known) {
  Mat<N> delta = Mat<N>::Zero();
  for (int j = 0; j < known.found; ++j)
    delta(j) = (known.right(j) - known.root.row(j).head(j).dot(delta.head(j))) / known.root(j, j);
  return delta;
}

/// Adds a row that determines the next direction, with sensitivity `size`.
template <int N>
void append(DiffuseKnowledge<N>& known, const Mat<N>& row, double size, double right) {
  const int j = known.found++;
  known.root.row(j).head(j) = row.head(j).transpose();
  known.root(j, j) = size;
  known.right(j) = right;
}

/// Whether a measurement depends on an undetermined direction by more than rounding.
template <int N>
[[nodiscard]] bool sees_new(const DiffuseState<N>& state, const Mat<N>& h, const Mat<N>& seen) {
  constexpr double rounding = 1e-10;
  const DiffuseKnowledge<N>& known = state.knowledge;
  const Mat<N> made_of = state.moved.cwiseAbs().transpose() * h.cwiseAbs();
  for (int j = known.found; j < known.directions; ++j)
    if (std::abs(known.turn.col(j).dot(seen)) >
        rounding * known.turn.col(j).cwiseAbs().dot(made_of))
      return true;
  return false;
}

/// Processes one measurement: updates the estimate of δ, applies the gate, then updates the filter.
template <int N, int M>
void read_diffuse(DiffuseState<N>& state,
                  Reading<N> reading,
                  const Gate& gate,
                  std::size_t i,
                  DiffuseStep<N, M>& out) {
  DiffuseKnowledge<N>& known = state.knowledge;
  Update<N>& update = out.step.updates[i];
  const double variance = reading.h.dot(state.x.cov * reading.h) + reading.variance;
  const double std = std::sqrt(variance), y = reading.value - reading.predicted;
  const Mat<N> seen = state.moved.transpose() * reading.h;
  out.F_inf[i] = 0.0;
  if (sees_new(state, reading.h, seen)) {
    const double size = turn_to(known, seen);
    const Mat<N> row = known.turn.transpose() * seen;
    out.innovation[i] = y - row.dot(estimate_of(known));
    append<N>(known, row / std, size / std, y / std);
    out.expected[i] = std::numeric_limits<double>::infinity();
    out.F_inf[i] = size * size;
  } else {
    const Mat<N> row = known.turn.transpose() * seen;
    DiffuseKnowledge<N> trial = known;
    const Residual residual = rotate_in<N>(trial, row / std, y / std);
    out.expected[i] = variance * residual.growth;
    out.innovation[i] = residual.value * std::sqrt(out.expected[i]);
    const double off = std::abs(residual.value);
    if (!(off <= gate.limit)) {
      update = {.h = reading.h, .gain = Mat<N>::Zero()};
      return;
    }
    if (off > gate.huber) {
      reading.variance += out.expected[i] * (off / gate.huber - 1.0);
      const double wider = std::sqrt(variance + out.expected[i] * (off / gate.huber - 1.0));
      trial = known;
      (void)rotate_in<N>(trial, row / wider, y / wider);
    }
    known = trial;
  }
  update = correct(state.x, reading, Gate{});
  state.moved -= update.gain * seen.transpose();
}

/// Propagates the state from epoch k − 1 to k (at k = 0: only its measurements).
template <int N, int M, int U>
void advance_diffuse(const LinearSeries<N, M, U>& series,
                     std::size_t k,
                     const Gate& gate,
                     DiffuseState<N>& state,
                     DiffuseStep<N, M>& out) {
  out.step.F.setIdentity();
  if (k > 0) {
    const auto transition = series.transition(state.x.mean, k);
    out.step.F = transition.F;
    predict(state.x, transition);
    state.moved = (transition.F * state.moved).eval();
  }
  Readings<N, M> readings;
  series.measure(state.x.mean, k, readings);
  out.step.count = readings.count;
  for (int i = 0; i < readings.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    readings.rows[at].predicted = readings.rows[at].h.dot(state.x.mean);
    read_diffuse<N, M>(state, readings.rows[at], gate, at, out);
  }
  out.step.filtered = state.x;
  out.moved = state.moved;
  out.knowledge = state.knowledge;
}

}  // namespace proofmass::estimate::detail
