#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/filter/diffuse.hpp"
#include "proofmass/estimate/filter/diffuse_moments.hpp"
#include "proofmass/estimate/filter/linear_run.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/rauch_tung_striebel.hpp"
#include "proofmass/estimate/filter/smoother.hpp"
#include "proofmass/estimate/filter/start.hpp"

// Linear Gaussian filter and smoother with known input, irregular time steps, missing measurements
// and an optionally diffuse start (filter/linear_series.hpp defines the model, filter/start.hpp the
// start).
//
// This is the filter and smoother of filter/smoother.hpp with all N states dynamic. Nonlinear
// models use the same code: any type that satisfies StateSpaceModel (filter/smoother.hpp), with
// Jacobians as F of its Transition and h of its Readings, gives the extended filter and smoother.
// WheelModel is one.
namespace proofmass::estimate {

/// Backward pass of smooth_linear(). Both give the same result but for rounding.
enum class Smoother {
  /// Bryson and Frazier: no inverse, so constants, unobservable states and a singular Q need no
  /// special treatment; more exact where some states are not observable. P − P Λ P loses digits
  /// where the filter is far less certain than the smoother: after a gap of 10 s with measured
  /// position, 2·10⁻³ of a variance.
  bryson_frazier,
  /// Rauch, Tung and Striebel: for comparison with other implementations, and for very precise
  /// measurements, long gaps or a very wide prior.
  rauch_tung_striebel,
};

struct LinearOptions {
  /// Its `patience` is ignored after a start with diffuse directions: there is no prior covariance
  /// to reset to.
  Gate gate = {};
  Smoother smoother = Smoother::bryson_frazier;
  bool lag_one = false;  ///< whether to fill LinearRun::lag_one, N² numbers an epoch
};

namespace detail {

/// Initial state of a diffuse start.
template <int N>
[[nodiscard]] DiffuseState<N> begin(const Start<N>& start) {
  DiffuseState<N> state;
  state.x = start.proper;
  state.moved.leftCols(start.directions) = start.basis.leftCols(start.directions);
  state.knowledge.directions = start.directions;
  return state;
}

/// cov(x[k+1], x[k]|N) = (I − P⁻ Λ⁻) F P, with P⁻ = F P Fᵀ + Q.
template <int N, int M, int U>
[[nodiscard]] Mat<N, N> lag_one(const LinearModel<N, M, U>& next,
                                const Mat<N, N>& P,
                                const Mat<N, N>& Lambda) {
  const Mat<N, N> FP = next.F * P;
  const Mat<N, N> predicted = FP * next.F.transpose() + next.Q;
  return FP - predicted * (Lambda * FP);
}

/// smooth_linear() from a prior, by Bryson and Frazier.
template <int N, int M, int U>
void smooth_proper(const LinearSeries<N, M, U>& series,
                   const Gaussian<N>& prior,
                   const Gate& gate,
                   LinearRun<N, M>& run) {
  Mat<N, N> from_next;  // Λ⁻: information from k + 1 and later, before the step back to k
  smooth(
      series, FilterState<N>{prior}, gate,
      [&](std::size_t k, const Step<N, N, M>& step) { note(series, k, step, run); },
      [&](std::size_t k, const Step<N, N, M>& step, const BackwardInformation<N>& later) {
        run.steps[k].smoothed = PackedGaussian<N>::of(
            {later.mean(step.filtered), later.template cov<N>(step.filtered)});
        if (run.lag_one.empty()) return;
        if (k < run.lag_one.size())
          run.lag_one[k] = lag_one<N, M, U>(series.model(k + 1), step.filtered.cov, from_next);
        BackwardInformation<N> before = later;
        look_back_readings(before, step);
        from_next = before.Lambda;
      });
}

/// smooth_linear() from a diffuse start: with δ = 0 as above, then corrected by the estimate of δ,
///     x̂[k|N] ← x̂[k|N] + X δ̂,   P[k|N] ← P[k|N] + X cov(δ) Xᵀ,   X = (I − P Λ) ∂x̂[k]/∂δ.
template <int N, int M, int U>
void smooth_diffuse(const LinearSeries<N, M, U>& series,
                    const Start<N>& start,
                    const Gate& gate,
                    LinearRun<N, M>& run) {
  BackwardInformation<N> later;
  Mat<N, N> from_next;
  DiffusePart<N> next;
  DiffuseKnowledge<N> known;
  there_and_back<DiffuseStep<N, M>, 128>(
      series.size(), begin(start),
      [&](DiffuseState<N>& state, std::size_t k, DiffuseStep<N, M>& step) {
        advance_diffuse(series, k, gate, state, step);
      },
      [&](std::size_t k, const DiffuseStep<N, M>& step) {
        note(series, k, step, run);
        known = step.knowledge;
      },
      [&](std::size_t k, const DiffuseStep<N, M>& step) {
        const Gaussian<N>& x = step.step.filtered;
        const Mat<N, N> moved = step.moved - x.cov * (later.Lambda * step.moved);
        const DiffusePart<N> part = diffuse_part<N>(moved, step.moved, known);
        run.steps[k].smoothed = with_diffuse<N>({later.mean(x), later.template cov<N>(x)}, part);
        if (k < run.lag_one.size()) {
          const Mat<N, N> given_zero = lag_one<N, M, U>(series.model(k + 1), x.cov, from_next);
          run.lag_one[k] =
              limit<N>(given_zero + next.root * part.root.transpose(), next.open, part.open);
        }
        next = part;
        BackwardInformation<N> before = later;
        look_back_readings(before, step.step);
        from_next = before.Lambda;
        look_back(later, step.step);
      });
}

/// Number of leading epochs with an undetermined direction.
template <int N, int M>
[[nodiscard]] std::size_t undetermined_epochs(const LinearRun<N, M>& run) {
  std::size_t k = 0;
  while (k < run.steps.size() && run.steps[k].diffuse_directions > 0) ++k;
  return k;
}

}  // namespace detail

/// Runs the filter. `start` describes the state at the first epoch, before its measurements; a
/// Gaussian<N> is accepted. Source: Särkkä (2013), theorem 4.2, one channel at a time; for a
/// diffuse start see filter/diffuse.hpp. Cost: O(epochs · (N³ + M N²)).
template <int N, int M, int U>
[[nodiscard]] LinearRun<N, M> filter_linear(LinearSeries<N, M, U> series,
                                            const std::type_identity_t<Start<N>>& start,
                                            const LinearOptions& options = {}) {
  PM_EXPECTS(start.directions >= 0 && start.directions <= N);
  LinearRun<N, M> run;
  run.steps.resize(series.size());
  if (start.directions > 0) {
    auto state = detail::begin(start);
    detail::DiffuseStep<N, M> step;
    for (std::size_t k = 0; k < series.size(); ++k) {
      detail::advance_diffuse(series, k, options.gate, state, step);
      detail::note(series, k, step, run);
    }
    return run;
  }
  series.set_reopened(start.proper.cov);
  FilterState<N> state{start.proper};
  filter(series, {0, series.size()}, options.gate, state,
         [&](std::size_t k, const Step<N, N, M>& step) { detail::note(series, k, step, run); });
  return run;
}

/// Filter and fixed-interval smoother: every state given every measurement, in
/// LinearStep::smoothed, and on request cov(x[k+1], x[k]) given every measurement.
///
///     x̂[k|N] = x̂ − P λ,   P[k|N] = P − P Λ P,   cov(x[k+1], x[k]|N) = (I − P⁻[k+1] Λ⁻[k+1]) F P
///
/// with λ⁻, Λ⁻ the adjoint from epoch k + 1 and later, before the step back to k. Source: Bierman
/// (1973), see filter/smoother.hpp; or, when requested, Rauch, Tung & Striebel (1965), see
/// filter/rauch_tung_striebel.hpp, which applies from the epoch at which the start is determined.
template <int N, int M, int U>
[[nodiscard]] LinearRun<N, M> smooth_linear(LinearSeries<N, M, U> series,
                                            const std::type_identity_t<Start<N>>& start,
                                            const LinearOptions& options = {}) {
  const bool by_gains = options.smoother == Smoother::rauch_tung_striebel;
  if (by_gains && start.directions == 0) {
    LinearRun<N, M> run = filter_linear(series, start, options);
    if (options.lag_one && series.size() > 1) run.lag_one.resize(series.size() - 1);
    detail::smooth_back_by_gains(series, 0, run);
    return run;
  }
  PM_EXPECTS(start.directions >= 0 && start.directions <= N);
  LinearRun<N, M> run;
  run.steps.resize(series.size());
  if (options.lag_one && series.size() > 1) run.lag_one.resize(series.size() - 1);
  if (start.directions == 0) {
    series.set_reopened(start.proper.cov);
    detail::smooth_proper(series, start.proper, options.gate, run);
    return run;
  }
  detail::smooth_diffuse(series, start, options.gate, run);
  if (by_gains) detail::smooth_back_by_gains(series, detail::undetermined_epochs(run), run);
  return run;
}

}  // namespace proofmass::estimate
