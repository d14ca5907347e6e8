#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/uncertainty/type_b.hpp"

namespace proofmass::calibrate {

/// Effect of a type B contribution on the nine parameters, in the order of
/// MultiPosition::covariance.
struct TypeBEffect {
  BudgetLine line;  ///< its sensitivity is that of the last parameter it acts on
  Eigen::Matrix<double, 9, 1> sensitivity = Eigen::Matrix<double, 9, 1>::Zero();
  bool common = false;  ///< one error for all parameters, not one of its own for each

  [[nodiscard]] Eigen::Matrix<double, 9, 9> covariance() const;
};

/// Effects of the lines that act on an estimated parameter. Errors: invalid_argument (see
/// add_type_b).
[[nodiscard]] Result<std::vector<TypeBEffect>> effects_of(const MultiPosition& fit,
                                                          View<TypeB> lines,
                                                          std::string_view reading_unit);

}  // namespace proofmass::calibrate
