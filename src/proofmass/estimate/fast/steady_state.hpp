#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/symmetric.hpp"

// Steady state of the filter and the smoother of a model with one step length and no missing
// measurements: gains and covariances of a long recording, without running through it.
namespace proofmass::estimate {

/// Limits for a long run. In a model of acceleration alone the gains of position and velocity have
/// limits but their variances do not. P is kept only for the states with a limit; the entries of
/// the others are 0.
///
///     P⁻ = F P⁺ Fᵀ + Q,  S = H P⁻ Hᵀ + R,  K = P⁻ Hᵀ S⁻¹,  P⁺ = (I − K H) P⁻
///     Λ = Fᵀ ((I − K H)ᵀ Λ (I − K H) + Hᵀ S⁻¹ H) F,        P[k|N] = P⁺ − P⁺ Λ P⁺
template <int N, int M>
struct SteadyState {
  Mat<N, M> gain = Mat<N, M>::Zero();                 ///< K, of all channels of an epoch at once
  Mat<M, M> innovation_variance = Mat<M, M>::Zero();  ///< S
  std::array<bool, static_cast<std::size_t>(N)>
      has_limit{};                             ///< whether a state's variance has one
  Symmetric<N> predicted, filtered, smoothed;  ///< P⁻, P⁺, P[k|N] far from both ends
  Symmetric<N> Lambda;                         ///< Λ of filter/bryson_frazier.hpp, after an epoch
  /// P⁺ Π, where Π projects on the observable subspace: x̂[k|N] = x̂[k|k] − P⁺ Π λ. All entries have
  /// a limit.
  Mat<N, N> seen = Mat<N, N>::Zero();
  double slowest_steps = 0.0;  ///< slowest time constant of the filter's observable error
  bool all_have_limits = false;

  /// A state's variance before the measurement, after it, and given all measurements.
  [[nodiscard]] std::optional<double> predicted_variance(int i) const { return of(predicted, i); }
  [[nodiscard]] std::optional<double> filtered_variance(int i) const { return of(filtered, i); }
  [[nodiscard]] std::optional<double> smoothed_variance(int i) const { return of(smoothed, i); }

 private:
  [[nodiscard]] std::optional<double> of(const Symmetric<N>& P, int i) const {
    if (!has_limit[static_cast<std::size_t>(i)]) return std::nullopt;
    return P(i, i);
  }
};

namespace detail {

struct SteadyParts {
  Eigen::MatrixXd gain, innovation_variance, predicted, filtered, smoothed, Lambda, seen;
  Eigen::Array<bool, Eigen::Dynamic, 1> has_limit;
  double slowest_steps = 0.0;
};

[[nodiscard]] Result<SteadyParts> steady_parts(const Eigen::MatrixXd& F,
                                               const Eigen::MatrixXd& Q,
                                               const Eigen::MatrixXd& H,
                                               const Eigen::VectorXd& R);

}  // namespace detail

/// A staircase form first splits the states into an observable and an unobservable part.
///
/// - Observable part: P⁻ by doubling (j steps of it are 2ʲ of the filter's).
/// - Unobservable part: doubled sums. A state has a limit if its unobservable component decays by
///   itself.
///
/// Errors: not_finite; not_positive_definite (a variance in R is not positive); not_observable if
/// even the gains have no limit: an unobservable component grows faster than the filter forgets, or
/// an observable one is constant and not driven, so that its variance tends to 0. Source: E. K.-W.
/// Chu, H.-Y. Fan, W.-W. Lin, C.-S. Wang, Int. J. Control 77 (2004) 767, for the doubling; P. Van
/// Dooren, IEEE Trans. Automatic Control 26 (1981) 111, for the staircase. Cost: O(N³) a doubling,
/// 10 to 40 of them.
template <int N, int M, int U>
[[nodiscard]] Result<SteadyState<N, M>> steady_state(const LinearModel<N, M, U>& model) {
  const Result<detail::SteadyParts> parts =
      detail::steady_parts(model.F, model.Q, model.H, model.R);
  if (!parts) return parts.error();
  SteadyState<N, M> out;
  out.gain = parts->gain;
  out.innovation_variance = parts->innovation_variance;
  out.predicted = Symmetric<N>::of(parts->predicted);
  out.filtered = Symmetric<N>::of(parts->filtered);
  out.smoothed = Symmetric<N>::of(parts->smoothed);
  out.Lambda = Symmetric<N>::of(parts->Lambda);
  out.seen = parts->seen;
  out.slowest_steps = parts->slowest_steps;
  out.all_have_limits = parts->has_limit.all();
  for (int i = 0; i < N; ++i) out.has_limit[static_cast<std::size_t>(i)] = parts->has_limit(i);
  return out;
}

}  // namespace proofmass::estimate
