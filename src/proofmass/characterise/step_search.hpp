#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "proofmass/characterise/drift_evidence.hpp"

namespace proofmass::characterise {

/// Where one step more would gain the most.
struct FoundStep {
  std::size_t block = 0;  ///< its first block
  double gain = 0.0;      ///< twice what it adds to the log-likelihood
};

/// Of all places two blocks or more from the ends, with what is fitted already and noise of density
/// S. Cost: O(n² columns).
[[nodiscard]] FoundStep find_step(const DriftEvidence& evidence,
                                  const Eigen::MatrixXd& fitted,
                                  const Eigen::VectorXd& density);

}  // namespace proofmass::characterise
