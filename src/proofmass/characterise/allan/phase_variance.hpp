#pragma once

#include <cstddef>

namespace proofmass::characterise {

/// An estimated variance of the Allan family, not yet corrected for the statistic's bias.
struct PhaseVariance {
  double variance = 0.0;
  std::size_t terms = 0;  ///< number of terms averaged; each statistic defines its terms
};

}  // namespace proofmass::characterise
