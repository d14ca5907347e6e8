#pragma once

#include <cstddef>

#include "proofmass/core/view.hpp"

// The loops over samples that the search for events spends its time in, for the vector units of
// several processors. Sums are taken in an order that is written out, and no multiply-add is fused:
// every processor gets the same digits.
namespace proofmass::signal {

/// What one filter put out over a block of places.
struct Tally {
  double mean, max;  ///< of |output|; NaN and 0 where there was none
};

/// out = in where that is finite, else NaN.
void copy_finite(const double* in, double* out, std::size_t n);

/// out[k] = (in[k] + in[k + w]) / 2 for k < n. The two do not overlap.
void average_pairs(const double* in, double* out, std::size_t n, std::size_t w);

inline constexpr std::size_t fine_block = 64;  ///< samples

/// Tallies of m[k] − (m[k−2w] + m[k−w] + m[k+w] + m[k+2w]) / 4 over blocks of fine_block places
/// from m[0] on; the mean is NaN if one output is. Reads 2 w values more at either side.
void tally_knocks(const double* m, std::size_t w, std::size_t blocks, Tally* out);

inline constexpr std::size_t coarse_block = 8;  ///< outputs

/// Tallies of blocks of coarse_block outputs; the mean is NaN if one output is.
void tally_outputs(const double* outputs, std::size_t blocks, Tally* out);

inline constexpr std::size_t base_block = 16;  ///< samples

/// Sums of blocks of base_block samples; NaN if one sample is.
void sum_blocks(const double* samples, std::size_t blocks, double* out);

/// Block means, the share of each block that is there, and the windows to take over them.
struct WindowSums {
  const double* mean;
  const float* share;
  std::size_t width;  ///< 1, 2 or 4
  double enough;      ///< least Σ share of a window
};

/// out[k] = Σ share · mean / Σ share over the blocks k … k + width − 1, k < n; NaN where Σ share is
/// less than `enough`.
void window_means(const WindowSums& in, double* out, std::size_t n);

/// The least |difference| of neighbours, NaN left out; ∞ if there is none.
[[nodiscard]] double least_difference(View<double> series);

}  // namespace proofmass::signal
