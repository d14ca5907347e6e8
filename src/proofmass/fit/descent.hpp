#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/fit/objective.hpp"

namespace proofmass::fit {

/// Descent methods, from the one that suits most problems to those that reach other basins.
enum class Way {
  levenberg_marquardt,
  cautious,  ///< the same with a short first step
  dogleg,    ///< Powell's, between the steepest descent and the Gauss–Newton step
};
inline constexpr Way all_ways[] = {Way::levenberg_marquardt, Way::cautious, Way::dogleg};

struct Descent {
  Way way = Way::levenberg_marquardt;
  std::vector<Eigen::Index> free;  ///< free parameters
  int max_iterations;
};

/// Moves p, where the residuals are finite, within the bounds until the sum of squares no longer
/// decreases; returns the number of iterations.
///
/// - Residuals are in units of their norm at the start, parameters in units in which each column of
///   the Jacobian there has that norm.
/// - A step s minimises |r + J s|² within a trust region. Levenberg–Marquardt: plus |D s|²/Δ, D²
///   the diagonal of JᵀJ, with Δ after Nielsen; dogleg: |D s| ≤ Δ.
/// - A step is projected onto the bounds, and its prediction is that of the projected step.
///   Parameters at a bound that the gradient presses against are left out of it.
///
/// Source: J. Nocedal, S. J. Wright, Numerical Optimization (2006), chapters 4 and 10; H. B.
/// Nielsen, Damping Parameter in Marquardt's Method, IMM-REP-1999-05. Cost: O(n p²) for each step
/// taken, O(p³) for each rejected.
int descend(const Objective& objective, const Descent& descent, Eigen::VectorXd& p);

}  // namespace proofmass::fit
