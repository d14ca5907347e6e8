#pragma once

#include <cstddef>

#include "proofmass/core/view.hpp"

// The loops that take most of the time of the event search, for the vector units of several
// processors. The order of summation is explicit and no multiply-add is fused: every processor
// gives the same digits.
namespace proofmass::signal {

/// Outputs of one filter over a block of positions.
struct Tally {
  double mean, max;  ///< mean and maximum |output|; NaN and 0 if there was none
};

/// out = in where that is finite, else NaN.
void copy_finite(const double* in, double* out, std::size_t n);

/// out[k] = (in[k] + in[k + w]) / 2 for k < n. The two do not overlap.
void average_pairs(const double* in, double* out, std::size_t n, std::size_t w);

inline constexpr std::size_t fine_block = 64;  ///< samples

/// Tallies of m[k] − (m[k−2w] + m[k−w] + m[k+w] + m[k+2w]) / 4 over blocks of fine_block positions
/// from m[0] on; the mean is NaN if one output is. Reads 2 w values beyond either side.
void tally_outliers(const double* m, std::size_t w, std::size_t blocks, Tally* out);

inline constexpr std::size_t coarse_block = 8;  ///< outputs

/// Tallies of blocks of coarse_block outputs; the mean is NaN if one output is.
void tally_outputs(const double* outputs, std::size_t blocks, Tally* out);

inline constexpr std::size_t base_block = 16;  ///< samples

/// Sums of blocks of base_block samples; NaN if one sample is.
void sum_blocks(const double* samples, std::size_t blocks, double* out);

/// Block means, the fraction of each block that is present, and the windows over them.
struct WindowSums {
  const double* mean;
  const float* share;
  std::size_t width;  ///< 1, 2 or 4
  double enough;      ///< minimum Σ share of a window
};

/// out[k] = Σ share · mean / Σ share over the blocks k … k + width − 1, k < n; NaN if Σ share is
/// less than `enough`.
void window_means(const WindowSums& in, double* out, std::size_t n);

/// The smallest |difference| of adjacent values, NaN excluded; ∞ if there is none.
[[nodiscard]] double least_difference(View<double> series);

}  // namespace proofmass::signal
