#pragma once

#include <optional>

#include "proofmass/estimate/tune_problem.hpp"

namespace proofmass::estimate {

/// Between what an unknown lies, in its own unit; an end that the data leave open is absent.
struct TuneInterval {
  std::optional<double> lower, upper;
};

/// How far an unknown may go from the maximum before twice the log-likelihood has fallen by `drop`,
/// all other unknowns fitted anew; absent where no factor does it.
/// Source: D. J. Venzon, S. H. Moolgavkar, Appl. Statist. 37 (1988) 87, by secants on the signed
/// root. Cost: about ten maximisations.
struct ProfileSide {
  std::size_t unknown = 0;
  bool upwards = true;
  double drop = 0.0;
  double log_std = 1.0;  ///< of the unknown's logarithm, about: where to look first
};
[[nodiscard]] std::optional<double> profile_limit(const TuneProblem& at_maximum,
                                                  const ProfileSide& side);

/// 95 %: by the curvature where that is narrow, else by the profile.
[[nodiscard]] TuneInterval interval_95(const TuneProblem& at_maximum,
                                       std::size_t unknown,
                                       double log_std);

/// Without the unknown: held at `value` in all its series.
[[nodiscard]] TuneProblem without(const TuneProblem& problem, std::size_t unknown, double value);

}  // namespace proofmass::estimate
