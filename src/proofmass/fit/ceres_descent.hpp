#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/fit/objective.hpp"

namespace proofmass::fit {

/// Ways downhill, from the one that suits most problems to those that end in other basins.
enum class Way { levenberg_marquardt, cautious, dogleg, subspace_dogleg, over_hills };
inline constexpr Way all_ways[] = {Way::levenberg_marquardt, Way::cautious, Way::dogleg,
                                   Way::subspace_dogleg, Way::over_hills};

struct Descent {
  Way way = Way::levenberg_marquardt;
  std::vector<Eigen::Index> free;  ///< parameters that may move
  int max_iterations;
};

/// Moves p, where the residuals are finite, downhill within the bounds until the sum of squares
/// falls no more; returns the iterations.
int descend(const Objective& objective, const Descent& descent, Eigen::VectorXd& p);

}  // namespace proofmass::fit
