#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Beyond this a stamp is a decoder's accident, in any unit: nanoseconds of 300 years are 1e19.
inline constexpr double largest_stamp = 1e20;

[[nodiscard]] inline bool is_stamp(double value) {
  return value < largest_stamp && value > -largest_stamp;
}

/// Steps of a column of stamps, from at most 65 536 of them spread over the file.
struct StampSteps {
  double median = 0.0;  ///< of the finite steps above zero; 0 if there are none
  double rounding =
      0.0;  ///< what all steps are multiples of, if more than 1 % of the median; else 0
  double mean_near = 0.0;  ///< mean of the steps within one rounding of the median
  double single = 0.0;     ///< from one row to the next where none is lost between: mean_near, or
                           ///< the median of the steps within half a step of it; where stamps
                           ///< jitter by more than 1 % and agree, by a line through them
  double middle = 0.0;     ///< median of all finite steps, those of zero and below too
  double ascending = 0.0;  ///< fraction of the finite steps that are not below zero
  double repeated = 0.0;   ///< fraction of the finite steps that are zero
  double long_run = 0.0;   ///< time a row over many rows, whatever a few gaps are; 0 if not known
  bool in_bursts = false;  ///< the single steps do not say what the long run does
  double coarse = 0.0;     ///< step where it is about one rounding (CoarseStamps); else 0
  double band = 0.0;       ///< TimeBase::band_s, in the unit of the stamps

  /// From one sample to the next as the sensor took them.
  [[nodiscard]] double nominal() const {
    if (coarse > 0.0) return coarse;
    return in_bursts ? long_run : single;
  }
  /// Whether a clock can have such steps, in whatever unit.
  [[nodiscard]] bool is_of_clock() const {
    constexpr double least = 1e-12;
    constexpr double most = 1e15;
    return median > least && median < most && nominal() > least && nominal() < most;
  }
  /// Up to what a step is a usual one: between bursts there is more than a nominal one.
  [[nodiscard]] double usual() const {
    if (coarse > 0.0) return coarse + 1.01 * rounding;
    return 1.5 * (median > nominal() ? median : nominal());
  }
};

/// Rows come in bursts (packets, a busy computer) where the long run differs by more than 5 % from
/// the single step, unless it is rows that are lost: then nine steps in ten are whole multiples of
/// the single one. Stamps that repeat now and then, less than one in eight, are rows written twice.
/// The long run is the mean over 16 or 64 stretches less those that are more than a quarter (or
/// three standard deviations by the median) off: they hold gaps.
[[nodiscard]] StampSteps measure_steps(View<double> stamps);

/// Whether every step is a number, not below zero and not above `usual`: then there is nothing to
/// unroll and nothing to mend.
[[nodiscard]] bool are_regular(View<double> stamps, double usual);

/// The rate at which the stamps are k / rate to the last bit; 0 if there is none.
[[nodiscard]] double uniform_rate_hz(View<double> stamps_s);

}  // namespace proofmass::io
