#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/characterise/drift/evidence.hpp"

namespace proofmass::characterise {

/// The most significant further step.
struct FoundStep {
  std::size_t block = 0;  ///< its first block
  double gain = 0.0;      ///< its gain in twice the log-likelihood
};

/// Searches all positions two blocks or more from the ends, given the fitted columns and noise of
/// density S. Cost: O(n² columns).
[[nodiscard]] FoundStep find_step(const DriftEvidence& evidence,
                                  const Eigen::MatrixXd& fitted,
                                  const Eigen::VectorXd& density);

}  // namespace proofmass::characterise
