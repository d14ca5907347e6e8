#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/tune/model.hpp"

namespace proofmass::estimate {

/// Log-likelihood of a series under a model, and its derivatives.
struct TuneScore {
  /// −½ Σ (ln 2π S + y²/S) over the innovations after the diffuse start, minus ½ Σ ln S∞ over those
  /// that end it: −∞ if some S is not positive.
  double log_likelihood = 0.0;
  std::vector<double> by_log;                 ///< ∂/∂ ln of each parameter
  std::size_t readings = 0, innovations = 0;  ///< finite values; those after the diffuse start
  std::size_t transitions = 0;
  double squares = 0.0;  ///< Σ y²/S
};

/// The likelihood alone. NaN in the series is a missing measurement. Cost: O(N), 10 to 60 ns a
/// sample.
[[nodiscard]] TuneScore log_likelihood(const TuneSystem& system, View<double> series);

/// The likelihood with its exact derivatives, by one backward pass without the inverse of a
/// covariance:
///
///     ∂L/∂Q = ½ Σ (λ λᵀ − Λ),   ∂L/∂R = ½ Σ (u² − D),   ∂L/∂F = Σ (λ x̂ₛᵀ − Λ F P),
///     u = y/S − Kᵀλ,   D = 1/S + KᵀΛK,
///
/// with λ, Λ the adjoint of the predicted state (filter/smoother.hpp's BackwardInformation with the
/// opposite sign). They stay finite as Q goes to 0. In the diffuse start S is infinite. Source: S.
/// J. Koopman, N. Shephard, Biometrika 79 (1992) 823; for the diffuse start J. Durbin, S. J.
/// Koopman, Time Series Analysis by State Space Methods (2012), sections 5.3 and 7.3.3. Cost: O(N);
/// stores six to nine doubles a sample during the call.
[[nodiscard]] TuneScore likelihood_score(const TuneSystem& system, View<double> series);

/// Innovations and their variances, NaN where the measurement is missing or the start is diffuse.
struct TuneInnovations {
  std::vector<double> innovation, variance;
};
[[nodiscard]] TuneInnovations innovations_of(const TuneSystem& system, View<double> series);

/// Deletion residuals: the difference of each measurement from what all others of the series
/// predict for it, u/D with variance 1/D; NaN where the measurement is missing, or the others
/// predict nothing. Source: P. de Jong, J. Penzer, Diagnosing shocks in time series, J. Amer.
/// Statist. Assoc. 93 (1998) 796. Cost: as likelihood_score().
struct TuneResiduals {
  std::vector<double> residual, variance;
};
[[nodiscard]] TuneResiduals deletion_residuals(const TuneSystem& system, View<double> series);

}  // namespace proofmass::estimate
