#pragma once

#include <Eigen/Core>

#include "proofmass/fit/nonlinear_least_squares.hpp"

namespace proofmass::fit {

/// The problem in Eigen types, always with a Jacobian. Holds a reference to the problem, which must
/// outlive it and have passed the checks of fit_least_squares.
class Objective {
 public:
  Objective(const LeastSquaresProblem& problem, const LeastSquaresOptions& options);

  [[nodiscard]] Eigen::Index parameters() const { return lower_.size(); }
  [[nodiscard]] Eigen::Index residual_count() const { return residual_count_; }
  [[nodiscard]] const Eigen::VectorXd& lower() const { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const { return upper_; }

  /// False if one of them is not finite.
  [[nodiscard]] bool residuals(const Eigen::VectorXd& p, Eigen::VectorXd& r) const;

  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& p) const;

 private:
  const LeastSquaresProblem& problem_;
  Eigen::Index residual_count_;
  Eigen::VectorXd lower_, upper_, scale_;
};

}  // namespace proofmass::fit
