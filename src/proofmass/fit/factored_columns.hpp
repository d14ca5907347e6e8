#pragma once

#include "proofmass/fit/variable_projection.hpp"

namespace proofmass::fit {

/// A = Q R, a column being left out where what the others do not make up of it is negligible
/// against its `length`. No inverse product.
[[nodiscard]] FactoredColumns factored(const Eigen::MatrixXd& A, Eigen::VectorXd length);

}  // namespace proofmass::fit
