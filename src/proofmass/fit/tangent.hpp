#pragma once

#include <Eigen/Core>

namespace proofmass::fit {

/// Linearisation by a Jacobian J at residuals r, columns scaled to unit length.
struct Tangent {
  Eigen::VectorXd step;             ///< −J⁺ r, the shortest in the scaled parameters
  Eigen::MatrixXd inverse_product;  ///< (JᵀJ)⁻¹, ∞ on the diagonal where not determined
  double along;                     ///< |component of r in the span of J|
  double condition;                 ///< ∞ if rank deficient
  Eigen::Index rank;
};

/// J needs at least as many rows as columns. Cost: O(n p²).
[[nodiscard]] Tangent tangent_at(const Eigen::MatrixXd& J, const Eigen::VectorXd& r);

}  // namespace proofmass::fit
