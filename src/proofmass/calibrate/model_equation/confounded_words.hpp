#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/model_equation/identifiability.hpp"
#include "proofmass/calibrate/model_fit.hpp"

namespace proofmass::calibrate {

/// The fitted values, with omitted coefficients at zero.
struct FittedValues {
  const Eigen::VectorXd& value;
  const Eigen::MatrixXd& covariance;
};

/// A group of coefficients that the rows cannot separate: its relations, the combinations that are
/// determined, and the remedy.
[[nodiscard]] Confounded describe_confounded(const TiedTerms& group,
                                             const std::vector<sensor::Coefficient>& coefficients,
                                             const FittedValues& fitted);

}  // namespace proofmass::calibrate
