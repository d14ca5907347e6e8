#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/fit/objective.hpp"

namespace proofmass::fit {

/// Descent methods, from the one that suits most problems to those that reach other basins.
enum class Way { levenberg_marquardt, cautious, dogleg, subspace_dogleg, over_hills };
inline constexpr Way all_ways[] = {Way::levenberg_marquardt, Way::cautious, Way::dogleg,
                                   Way::subspace_dogleg, Way::over_hills};

struct Descent {
  Way way = Way::levenberg_marquardt;
  std::vector<Eigen::Index> free;  ///< free parameters
  int max_iterations;
};

/// Moves p, where the residuals are finite, within the bounds until the sum of squares no longer
/// decreases; returns the number of iterations.
int descend(const Objective& objective, const Descent& descent, Eigen::VectorXd& p);

}  // namespace proofmass::fit
