#pragma once

#include <Eigen/Core>

namespace proofmass::fit {

/// What a Jacobian J says at residuals r, its columns brought to unit length.
struct Tangent {
  Eigen::VectorXd step;             ///< −J⁺ r, the shortest in the scaled parameters
  Eigen::MatrixXd inverse_product;  ///< (JᵀJ)⁻¹, ∞ on the diagonal where J does not determine
  double along;                     ///< |part of r in the span of J|
  double condition;                 ///< ∞ if the rank is not full
  Eigen::Index rank;
};

/// J needs at least as many rows as columns. Cost: O(n p²).
[[nodiscard]] Tangent tangent_at(const Eigen::MatrixXd& J, const Eigen::VectorXd& r);

}  // namespace proofmass::fit
