#pragma once

#include "proofmass/fit/variable_projection.hpp"

namespace proofmass::fit {

/// A = Q R. A column is dropped if its component orthogonal to the others is negligible relative to
/// its `length`. No inverse product.
[[nodiscard]] FactoredColumns factored(const Eigen::MatrixXd& A, Eigen::VectorXd length);

}  // namespace proofmass::fit
