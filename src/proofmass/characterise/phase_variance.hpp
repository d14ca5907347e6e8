#pragma once

#include <cstddef>

namespace proofmass::characterise {

/// A variance of the Allan family, as estimated: not yet corrected for the statistic's bias.
struct PhaseVariance {
  double variance = 0.0;
  std::size_t terms = 0;  ///< how many terms were averaged; each statistic says what its terms are
};

}  // namespace proofmass::characterise
