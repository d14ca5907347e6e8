#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/fit/objective.hpp"

namespace proofmass::fit {

/// The unbounded parameters in which the residuals are jointly linear, found by trying. To minimise
/// over the others alone, the linear ones following, widens the basin of the minimum.
///
/// Source: G. H. Golub, V. Pereyra, Separable nonlinear least squares: the variable projection
/// method and its applications (2003), section 1.
class LinearPart {
 public:
  /// Refers to the objective, which must outlive it. Cost: O(p²) residuals.
  LinearPart(const Objective& objective, const Eigen::VectorXd& at);

  [[nodiscard]] const std::vector<Eigen::Index>& linear() const { return linear_; }
  [[nodiscard]] const std::vector<Eigen::Index>& others() const { return others_; }

  /// p with its linear parameters at their best for the others; p as it is where they have none.
  [[nodiscard]] Eigen::VectorXd completed(Eigen::VectorXd p) const;

  /// The problem in the others. Refers to this part.
  [[nodiscard]] LeastSquaresProblem reduced_problem(const Eigen::VectorXd& start) const;

 private:
  const Objective& objective_;
  std::vector<Eigen::Index> linear_, others_;
  Eigen::VectorXd unit_;  // a change of each parameter that is felt
};

}  // namespace proofmass::fit
