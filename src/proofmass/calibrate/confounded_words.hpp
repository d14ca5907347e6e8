#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/identifiability.hpp"
#include "proofmass/calibrate/model_fit.hpp"

namespace proofmass::calibrate {

/// What was fitted in place of the coefficients, the ones left out counting as zero.
struct FittedValues {
  const Eigen::VectorXd& value;
  const Eigen::MatrixXd& covariance;
};

/// A group of coefficients that the rows cannot tell apart: its relations, what can be told of it,
/// and what helps.
[[nodiscard]] Confounded describe_confounded(const TiedTerms& group,
                                             const std::vector<sensor::Coefficient>& coefficients,
                                             const FittedValues& fitted);

}  // namespace proofmass::calibrate
