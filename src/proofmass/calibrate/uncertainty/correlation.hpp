#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/core/result.hpp"

namespace proofmass::calibrate {

/// An L with L Lᵀ = C, also for singular C. Negative eigenvalues, due to rounding, count as 0.
[[nodiscard]] Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance);

/// Checks that it is empty, or a valid correlation matrix of this size. Errors: invalid_argument.
[[nodiscard]] Status check_correlation(const Eigen::MatrixXd& correlation, std::size_t count);

}  // namespace proofmass::calibrate
