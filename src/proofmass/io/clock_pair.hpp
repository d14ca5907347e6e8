#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// How one clock of a recording stands to another: other = offset + (1 + drift) · base, plus
/// delays.
struct ClockPair {
  double offset_s = 0.0;        ///< other clock less base clock where that is 0
  double drift_ppm = 0.0;       ///< by how much the other clock is fast
  double drift_std_ppm = 0.0;   ///< standard deviation
  double base_jitter_s = 0.0;   ///< of a step about the median one, robust
  double other_jitter_s = 0.0;  ///< likewise
  std::size_t blocks = 0;       ///< that the line is fitted to
  std::size_t outliers = 0;     ///< of these: given no weight
};

/// Fits the line through the medians of 32 … 256 blocks of rows by iterated weights (Tukey's
/// biweight at 4.685 robust standard deviations, from the line of Theil and Sen on). Medians,
/// because a computer's stamps are late now and then and never early; the standard deviation is
/// from the scatter of the blocks and their likeness to their neighbours, so that it holds where
/// the delays of neighbouring rows are alike. Both in seconds, equally long; rows that are no
/// number in either are passed over. Source: P. K. Sen, J. Am. Stat. Assoc. 63 (1968) 1379; P. W.
/// Holland and R. E. Welsch, Comm. Stat. A6 (1977) 813. Errors: too_few_samples (fewer than 64
/// rows), not_observable (a clock that stands still).
[[nodiscard]] Result<ClockPair> compare_clocks(View<double> base_s, View<double> other_s);

/// Compares the channels of a recording that are clocks, by name or unit and because they ascend,
/// with its time base, and tells offset, drift and jitter of each in a note. Where the recording's
/// own clock is no calendar's and another is, the first sample's time is taken from that one; where
/// another is steadier by far, the note says how to take it.
void tell_other_clocks(Recording& recording);

}  // namespace proofmass::io
