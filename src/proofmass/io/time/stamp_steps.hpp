#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Larger stamps are decoding errors in any unit: nanoseconds of 300 years are 1e19.
inline constexpr double largest_stamp = 1e20;

[[nodiscard]] inline bool is_stamp(double value) {
  return value < largest_stamp && value > -largest_stamp;
}

/// Intervals of a column of stamps, from at most 65 536 of them spread over the file.
struct StampSteps {
  double median = 0.0;  ///< median of the finite positive intervals; 0 if none
  double rounding =
      0.0;  ///< common divisor of all intervals, if more than 1 % of the median; else 0
  double mean_near = 0.0;  ///< mean of the intervals within one rounding of the median
  double single = 0.0;     ///< interval between adjacent rows without loss: mean_near, or the
                           ///< median of the intervals within half a step of it; if stamps jitter
                           ///< by more than 1 % and agree, from a line through them
  double middle = 0.0;     ///< median of all finite intervals, including zero and negative ones
  double ascending = 0.0;  ///< fraction of the finite intervals that are not negative
  double repeated = 0.0;   ///< fraction of the finite steps that are zero
  double long_run = 0.0;   ///< time per row over many rows, insensitive to a few gaps; 0 if unknown
  bool in_bursts = false;  ///< single intervals differ from the long run
  double coarse = 0.0;     ///< interval if it is about one rounding (CoarseStamps); else 0
  double band = 0.0;       ///< TimeBase::band_s, in the unit of the stamps

  /// Actual sample period of the sensor.
  [[nodiscard]] double nominal() const {
    if (coarse > 0.0) return coarse;
    return in_bursts ? long_run : single;
  }
  /// True if a clock can have such intervals, in any unit.
  [[nodiscard]] bool is_of_clock() const {
    constexpr double least = 1e-12;
    constexpr double most = 1e15;
    return median > least && median < most && nominal() > least && nominal() < most;
  }
  /// Largest interval that counts as usual: between bursts it exceeds the nominal one.
  [[nodiscard]] double usual() const {
    if (coarse > 0.0) return coarse + 1.01 * rounding;
    return 1.5 * (median > nominal() ? median : nominal());
  }
};

/// Determines whether rows come in bursts (packets, a busy computer): the long run differs by more
/// than 5 % from the single interval, and rows are not lost, which would make nine in ten intervals
/// whole multiples of the single one. Occasionally repeated stamps, less than one in eight, are
/// rows written twice. The long run is the mean over 16 or 64 segments, without those that deviate
/// by more than a quarter (or three standard deviations from the median): these contain gaps.
[[nodiscard]] StampSteps measure_steps(View<double> stamps);

/// True if every interval is a number, not negative and not above `usual`: then there is nothing to
/// unwrap or correct.
[[nodiscard]] bool are_regular(View<double> stamps, double usual);

/// The rate for which the stamps equal k / rate to the last bit; 0 if there is none.
[[nodiscard]] double uniform_rate_hz(View<double> stamps_s);

}  // namespace proofmass::io
