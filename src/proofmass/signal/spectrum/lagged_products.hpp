#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/spectrum/lane_fourier.hpp"

namespace proofmass::signal {

/// Up to sixteen segments of a series, `step` apart, for LaneFourier to transform in parallel.
struct Stretches {
  View<double> series;
  double mean;         ///< subtracted from the values
  bool presence;       ///< use 1 for each finite value, instead of the value
  std::size_t step;    ///< from the start of one segment to the next
  std::size_t length;  ///< length of a segment; zeros follow
};

/// Loads the segments that begin at `first`, first + step, …: a missing value is zero, as is
/// anything beyond the series or the segment.
void load_stretches(const Stretches& stretches, std::size_t first, std::vector<LaneComplex>& x);

/// Σ x[n] x[n+k] over the pairs with both values finite, and the number of pairs, k = 0 … lags.
struct LaggedProducts {
  std::vector<double> sums, pairs;
};

/// Products of the series minus `mean`. The numbers of pairs are rounded to integers.
/// Cost: see autocorrelation() in whiteness.hpp.
[[nodiscard]] LaggedProducts lagged_products(View<double> series, double mean, std::size_t lags);

}  // namespace proofmass::signal
