#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"

// Sensitivity of an axis to acceleration across it.
namespace proofmass::calibrate {

/// Cross-axis sensitivity of one axis, a fraction of its own sensitivity.
struct CrossAxis {
  /// Absent if it does not exceed zero significantly: the norm of noise is never zero.
  std::optional<Uncertain> value;
  double upper_95 = 0.0;  ///< upper limit in at least 95 % of repetitions
  double p = 1.0;         ///< p-value of the hypothesis that it is zero
  std::string reason;     ///< a sentence, if there is no value
};

/// From the ratio of the two cross sensitivities to the direct one, r = (S_xy, S_xz)/S_x, with
/// covariance C and its degrees of freedom (0: infinite):
///
///     c = |r| − u_⊥²/(2 |r|),   std² = eᵀ C e,   e = r/|r|,   u_⊥² = trace C − eᵀ C e
///
/// The second term removes the bias of the norm due to noise across r, to second order. There is a
/// value if rᵀ C⁻¹ r is significant at 1 %. The upper limit is the 95 % quantile of |r + noise of
/// covariance C|: its coverage is at least that, and higher near zero.
///
/// Errors: not_finite, invalid_argument (a variance below zero).
[[nodiscard]] Result<CrossAxis> cross_axis_sensitivity(const Eigen::Vector2d& ratio,
                                                       const Eigen::Matrix2d& covariance,
                                                       double dof = 0.0);

/// Cross-axis sensitivity of each axis from a sensitivity matrix S(axis, direction), c = √(S_xy² +
/// S_xz²)/S_x, and the covariance of its elements row by row (xx, xy, xz, yx …), by the delta
/// method. Source: M. A. Lele, thesis, Dalhousie University (2010), section 2.2. Errors:
/// not_finite; not_observable (an axis without sensitivity along itself).
[[nodiscard]] Result<std::array<CrossAxis, 3>> cross_axis_sensitivities(
    const Eigen::Matrix3d& sensitivity,
    const Eigen::Matrix<double, 9, 9>& covariance,
    double dof = 0.0);

}  // namespace proofmass::calibrate
