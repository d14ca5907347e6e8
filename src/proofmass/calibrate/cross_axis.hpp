#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"

// How much of an acceleration across an axis shows on that axis.
namespace proofmass::calibrate {

/// Cross-axis sensitivity of one axis, a fraction of its own sensitivity.
struct CrossAxis {
  /// Absent where it is not above zero beyond chance: a length of noise is never zero.
  std::optional<Uncertain> value;
  double upper_95 = 0.0;  ///< it lies below this in at least 95 % of repetitions
  double p = 1.0;         ///< of so much or more if it were zero
  std::string reason;     ///< a sentence, where there is no value
};

/// From the two sensitivities across the axis over the one along it, r = (S_xy, S_xz)/S_x, with
/// covariance C and its degrees of freedom (0: infinitely many):
///
///     c = |r| − u_⊥²/(2 |r|),   std² = eᵀ C e,   e = r/|r|,   u_⊥² = trace C − eᵀ C e
///
/// The second term takes out what noise across r adds to its length, to second order. There is a
/// value where rᵀ C⁻¹ r exceeds what chance gives in 1 % of cases. The upper bound is the 95 %
/// quantile of |r + noise of covariance C|: it holds at least that often, and more often near zero.
///
/// Errors: not_finite, invalid_argument (a variance below zero).
[[nodiscard]] Result<CrossAxis> cross_axis_sensitivity(const Eigen::Vector2d& ratio,
                                                       const Eigen::Matrix2d& covariance,
                                                       double dof = 0.0);

/// Of each axis from a matrix of sensitivities S(axis, direction), c = √(S_xy² + S_xz²)/S_x, and
/// the covariance of its elements row by row (xx, xy, xz, yx …), by the delta method.
/// Source: M. A. Lele, thesis, Dalhousie University (2010), section 2.2.
/// Errors: not_finite; not_observable (an axis without sensitivity along itself).
[[nodiscard]] Result<std::array<CrossAxis, 3>> cross_axis_sensitivities(
    const Eigen::Matrix3d& sensitivity,
    const Eigen::Matrix<double, 9, 9>& covariance,
    double dof = 0.0);

}  // namespace proofmass::calibrate
