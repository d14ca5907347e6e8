#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/tune_model.hpp"

namespace proofmass::estimate {

/// Log-likelihood of a series under a model, and its derivatives.
struct TuneScore {
  /// −½ Σ (ln 2π S + y²/S) over the innovations behind the diffuse start, less ½ Σ ln S∞ over those
  /// that end it: −∞ where some S is not positive.
  double log_likelihood = 0.0;
  std::vector<double> by_log;                 ///< ∂/∂ ln of each parameter
  std::size_t readings = 0, innovations = 0;  ///< finite values; those behind the diffuse start
  std::size_t transitions = 0;
  double squares = 0.0;  ///< Σ y²/S
};

/// The likelihood alone. NaN in the series is a missing reading. Cost: O(N), 10 to 60 ns a sample.
[[nodiscard]] TuneScore log_likelihood(const TuneSystem& system, View<double> series);

/// With its exact derivatives, by one backward pass that holds no inverse of a covariance:
///
///     ∂L/∂Q = ½ Σ (λ λᵀ − Λ),   ∂L/∂R = ½ Σ (u² − D),   ∂L/∂F = Σ (λ x̂ₛᵀ − Λ F P),
///     u = y/S − Kᵀλ,   D = 1/S + KᵀΛK,
///
/// λ, Λ being what all later readings say of the predicted state (kalman.hpp's Hindsight with the
/// other sign). They stay finite as Q goes to 0. In the diffuse start S is infinite.
/// Source: S. J. Koopman, N. Shephard, Biometrika 79 (1992) 823; for the diffuse start J. Durbin,
/// S. J. Koopman, Time Series Analysis by State Space Methods (2012), sections 5.3 and 7.3.3.
/// Cost: O(N); keeps six to nine doubles a sample meanwhile.
[[nodiscard]] TuneScore likelihood_score(const TuneSystem& system, View<double> series);

/// Innovations and their variances, NaN where there is no reading or the start was diffuse.
struct TuneInnovations {
  std::vector<double> innovation, variance;
};
[[nodiscard]] TuneInnovations innovations_of(const TuneSystem& system, View<double> series);

}  // namespace proofmass::estimate
