#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "proofmass/estimate/filter/smoother.hpp"

// Shared by filter/iterated_filter.hpp and filter/iterated_smoother.hpp: models linearised about
// given states, and the change of a state.
namespace proofmass::estimate {

struct IterateOptions {
  int iterations = 30;  ///< maximum; 1 is the plain extended filter or smoother
  /// Convergence limit: largest change of a state, in its standard deviations.
  double tolerance = 1e-10;
};

/// Result of the iteration.
struct Iterated {
  bool converged = false;
  int iterations = 0;
  /// Largest change in the last iteration, in standard deviations of that state.
  double change = 0.0;
};

namespace detail {

template <StateSpaceModel Model>
using ReadingsOf = Readings<Model::states, Model::channels>;

/// Measurements linearised about `at`, for the state x.
template <StateSpaceModel Model>
void measure_about(const Model& model,
                   const Mat<Model::states>& at,
                   const Mat<Model::states>& x,
                   std::size_t k,
                   ReadingsOf<Model>& out) {
  model.measure(at, k, out);
  for (int i = 0; i < out.count; ++i) {
    auto& reading = out.rows[static_cast<std::size_t>(i)];
    reading.predicted += reading.h.dot(x - at);
  }
}

/// A model with its own motion, whose measurements are linearised about one state, or absent.
template <StateSpaceModel Model>
struct ReadAbout {
  static constexpr int states = Model::states, moving = Model::moving, channels = Model::channels;
  const Model& model;
  const Mat<states>* at;  ///< null: no measurements

  [[nodiscard]] std::size_t size() const { return model.size(); }
  [[nodiscard]] int active() const { return active_states(model); }
  [[nodiscard]] Transition<states, moving> transition(const Mat<states>& x, std::size_t k) const {
    return model.transition(x, k);
  }
  void measure(const Mat<states>& x, std::size_t k, ReadingsOf<Model>& out) const {
    out.count = 0;
    if (at != nullptr) measure_about(model, *at, x, k, out);
  }
  void reopen(Gaussian<states>& x, std::size_t k) const { model.reopen(x, k); }
};

/// A model linearised about a path, which has a state for each epoch.
template <StateSpaceModel Model>
struct LinearAbout {
  static constexpr int states = Model::states, moving = Model::moving, channels = Model::channels;
  const Model& model;
  const Mat<states>* path;

  [[nodiscard]] std::size_t size() const { return model.size(); }
  [[nodiscard]] int active() const { return active_states(model); }
  [[nodiscard]] Transition<states, moving> transition(const Mat<states>& x, std::size_t k) const {
    const Mat<states>& at = path[k - 1];
    Transition<states, moving> step = model.transition(at, k);
    step.mean += step.F * (x - at).template head<moving>();
    return step;
  }
  void measure(const Mat<states>& x, std::size_t k, ReadingsOf<Model>& out) const {
    measure_about(model, path[k], x, k, out);
  }
  void reopen(Gaussian<states>& x, std::size_t k) const { model.reopen(x, k); }
};

/// Σ (z − h(x))² / R at epoch k.
template <StateSpaceModel Model>
[[nodiscard]] double misfit(const Model& model, const Mat<Model::states>& x, std::size_t k) {
  ReadingsOf<Model> readings;
  model.measure(x, k, readings);
  double sum = 0.0;
  for (int i = 0; i < readings.count; ++i) {
    const auto& r = readings.rows[static_cast<std::size_t>(i)];
    sum += (r.value - r.predicted) * (r.value - r.predicted) / r.variance;
  }
  return sum;
}

/// dᵀ A⁻¹ d of a positive semi-definite A; components of d outside A's range are ignored.
template <int N>
[[nodiscard]] double squared_distance(Mat<N, N> A, Mat<N> d) {
  const Mat<N> whole = A.diagonal();
  double sum = 0.0;
  for (int j = 0; j < N; ++j) {
    if (!(A(j, j) > 1e-12 * whole(j))) continue;
    sum += d(j) * d(j) / A(j, j);
    for (int i = j + 1; i < N; ++i) {
      const double l = A(i, j) / A(j, j);
      d(i) -= l * d(j);
      for (int c = j + 1; c <= i; ++c) A(i, c) -= l * A(c, j);
    }
  }
  return sum;
}

/// The largest change of a state in its standard deviations; a state without variance does not
/// change.
template <int N>
[[nodiscard]] double largest_change(const Mat<N>& from, const Gaussian<N>& to) {
  double largest = 0.0;
  for (int i = 0; i < N; ++i)
    if (to.cov(i, i) > 0.0)
      largest = std::max(largest, std::abs(to.mean(i) - from(i)) / std::sqrt(to.cov(i, i)));
  return largest;
}

}  // namespace detail

}  // namespace proofmass::estimate
