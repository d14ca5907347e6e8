#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Relation of one clock of a recording to another: other = offset + (1 + drift) · base, plus
/// delays.
struct ClockPair {
  double offset_s = 0.0;        ///< other clock minus base clock where that is 0
  double drift_ppm = 0.0;       ///< rate error of the other clock; positive if fast
  double drift_std_ppm = 0.0;   ///< standard deviation
  double base_jitter_s = 0.0;   ///< jitter of an interval about the median, robust
  double other_jitter_s = 0.0;  ///< likewise
  std::size_t blocks = 0;       ///< number of blocks in the fit
  std::size_t outliers = 0;     ///< blocks with zero weight
};

/// Fits a line to the medians of 32 … 256 blocks of rows by iteratively reweighted least squares
/// (Tukey's biweight at 4.685 robust standard deviations, starting from the Theil–Sen line).
///
/// - Medians, because a computer's stamps are sometimes late but never early.
/// - The standard deviation is from the scatter of the blocks and their autocorrelation, so that it
///   is valid if the delays of adjacent rows are similar.
/// - Both series in seconds, of equal length; rows without a number in either are skipped.
///
/// Source: P. K. Sen, J. Am. Stat. Assoc. 63 (1968) 1379; P. W. Holland and R. E. Welsch, Comm.
/// Stat. A6 (1977) 813. Errors: too_few_samples (fewer than 64 rows), not_observable (a clock that
/// does not advance).
[[nodiscard]] Result<ClockPair> compare_clocks(View<double> base_s, View<double> other_s);

/// Compares the clock channels of a recording, identified by name or unit and because they
/// increase, with its time base, and reports offset, drift and jitter of each in a note. If the
/// recording's own clock is not a calendar time and another is, the first sample's time is taken
/// from that one; if another has far less jitter, the note explains how to select it.
void note_other_clocks(Recording& recording);

}  // namespace proofmass::io
