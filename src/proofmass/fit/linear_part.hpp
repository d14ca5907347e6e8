#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/fit/objective.hpp"

namespace proofmass::fit {

/// The unbounded parameters in which the residuals are jointly linear, found numerically.
/// Minimising over the others alone, with the linear ones eliminated, widens the basin of the
/// minimum.
///
/// Source: G. H. Golub, V. Pereyra, Separable nonlinear least squares: the variable projection
/// method and its applications (2003), section 1.
class LinearPart {
 public:
  /// Holds a reference to the objective, which must outlive it. Cost: O(p²) residuals.
  LinearPart(const Objective& objective, const Eigen::VectorXd& at);

  [[nodiscard]] const std::vector<Eigen::Index>& linear() const { return linear_; }
  [[nodiscard]] const std::vector<Eigen::Index>& others() const { return others_; }

  /// p with its linear parameters at their optimum given the others; p unchanged if none exists.
  [[nodiscard]] Eigen::VectorXd completed(Eigen::VectorXd p) const;

  /// The problem in the other parameters. Holds a reference to this object.
  [[nodiscard]] LeastSquaresProblem reduced_problem(const Eigen::VectorXd& start) const;

 private:
  const Objective& objective_;
  std::vector<Eigen::Index> linear_, others_;
  Eigen::VectorXd unit_;  // a noticeable change of each parameter
};

}  // namespace proofmass::fit
