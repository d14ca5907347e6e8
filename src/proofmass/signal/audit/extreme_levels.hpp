#pragma once

#include <cstddef>
#include <vector>

namespace proofmass::signal {

/// How often the lowest value occurs, and the eight values next to it.
struct ExtremeLevels {
  std::size_t at_extreme = 0;
  std::size_t beside = 0;         ///< number of the others, at most eight
  std::size_t most_frequent = 0;  ///< how often the most frequent of them occurs
  double step = 0.0;  ///< least distance of two neighbours; 0 if there is only one value
};

/// Of finite values. Those of the highest are those of the lowest of the negated values. Cost:
/// O(N log N).
[[nodiscard]] ExtremeLevels levels_at_lowest(std::vector<double> values);

}  // namespace proofmass::signal
