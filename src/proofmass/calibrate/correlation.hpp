#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/core/result.hpp"

namespace proofmass::calibrate {

/// An L with L Lᵀ = C, of singular C too. Negative eigenvalues, which are rounding, count as 0.
[[nodiscard]] Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance);

/// Is it empty, or a possible correlation matrix of so many variables? Errors: invalid_argument.
[[nodiscard]] Status check_correlation(const Eigen::MatrixXd& correlation, std::size_t count);

}  // namespace proofmass::calibrate
