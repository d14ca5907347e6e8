#pragma once

#include <optional>

#include "proofmass/estimate/tune/problem.hpp"

namespace proofmass::estimate {

/// Interval of a parameter, in its own unit; an unbounded end is absent.
struct TuneInterval {
  std::optional<double> lower, upper;
};

/// Factor from the maximum at which twice the log-likelihood has fallen by `drop`, with all other
/// unknowns refitted; absent if there is none. Source: D. J. Venzon, S. H. Moolgavkar, Appl.
/// Statist. 37 (1988) 87, by secants on the signed root. Cost: about ten maximisations.
struct ProfileSide {
  std::size_t unknown = 0;
  bool upwards = true;
  double drop = 0.0;
  double log_std = 1.0;  ///< of the unknown's logarithm, about: where to look first
};
[[nodiscard]] std::optional<double> profile_limit(const TuneProblem& at_maximum,
                                                  const ProfileSide& side);

/// 95 %: from the curvature if that is narrow, else from the profile.
[[nodiscard]] TuneInterval interval_95(const TuneProblem& at_maximum,
                                       std::size_t unknown,
                                       double log_std);

/// The problem with the unknown held at `value` in all its series.
[[nodiscard]] TuneProblem without(const TuneProblem& problem, std::size_t unknown, double value);

}  // namespace proofmass::estimate
