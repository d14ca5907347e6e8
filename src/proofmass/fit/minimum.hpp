#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "proofmass/fit/objective.hpp"
#include "proofmass/fit/tangent.hpp"

namespace proofmass::fit {

struct Minimum {
  Eigen::VectorXd p, r;
  double rss = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Index> free;  ///< parameters not at a bound
  Tangent tangent = {};            ///< in the free parameters
  bool converged = false;
  int iterations = 0;

  /// Not converged, or so close to a singular Jacobian that the basin may be the wrong one.
  [[nodiscard]] bool in_doubt() const { return !converged || !(tangent.condition < 1e10); }
};

/// The lowest minimum found from the start, where the residuals are finite: by one descent method
/// and, if that is in doubt and the search may continue, by others until one is not.
[[nodiscard]] Minimum lowest_minimum(const Objective& objective,
                                     const Eigen::VectorXd& start,
                                     const LeastSquaresOptions& options);

}  // namespace proofmass::fit
