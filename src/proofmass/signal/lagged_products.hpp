#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/lane_fourier.hpp"

namespace proofmass::signal {

/// Up to sixteen stretches of a series, `step` apart, for LaneFourier to transform side by side.
struct Stretches {
  View<double> series;
  double mean;         ///< to take off
  bool presence;       ///< one for each value that is finite, instead of the value
  std::size_t step;    ///< from the first of a stretch to the first of the next
  std::size_t length;  ///< of a stretch; zeros follow
};

/// Loads the stretches that begin at `first`, first + step, …: a missing value is zero, as is what
/// lies beyond the series or the stretch.
void load_stretches(const Stretches& stretches, std::size_t first, std::vector<LaneComplex>& x);

/// Σ x[n] x[n+k] over the pairs with both values finite, and their number, k = 0 … lags.
struct LaggedProducts {
  std::vector<double> sums, pairs;
};

/// Of the series less `mean`. The pairs are rounded to whole numbers.
/// Cost: as autocorrelation() in whiteness.hpp says.
[[nodiscard]] LaggedProducts lagged_products(View<double> series, double mean, std::size_t lags);

}  // namespace proofmass::signal
