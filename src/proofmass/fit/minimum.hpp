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
  std::vector<Eigen::Index> free;  ///< parameters that no bound holds
  Tangent tangent = {};            ///< in the free ones
  bool converged = false;
  int iterations = 0;

  /// Not converged, or so near a singular Jacobian that the basin may be a wrong one.
  [[nodiscard]] bool in_doubt() const { return !converged || !(tangent.condition < 1e10); }
};

/// The lowest that is found from the start, where the residuals are finite: by one way downhill
/// and, if that ends in doubt and more may be searched, by others until one does not.
[[nodiscard]] Minimum lowest_minimum(const Objective& objective,
                                     const Eigen::VectorXd& start,
                                     const LeastSquaresOptions& options);

}  // namespace proofmass::fit
