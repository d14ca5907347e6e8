#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Steps of a column of stamps, from at most 65 536 of them spread over the file.
struct StampSteps {
  double median = 0.0;  ///< of the finite steps above zero; 0 if there are none
  double rounding =
      0.0;  ///< what all steps are multiples of, if more than 1 % of the median; else 0
  double mean_near = 0.0;  ///< mean of the steps within one rounding of the median
  double ascending = 0.0;  ///< fraction of the finite steps that are not below zero
  double repeated = 0.0;   ///< fraction of the finite steps that are zero
};
[[nodiscard]] StampSteps measure_steps(View<double> stamps);

/// Whether every step is a number, not below zero and not above one and a half of `step`: then
/// there is nothing to unroll and nothing to mend.
[[nodiscard]] bool are_regular(View<double> stamps, double step);

/// Undoes the running over of a counter of 16, 24, 31 or 32 bits; returns how often it did. The
/// stamps are less `origin`, the counter's reading at the first.
std::size_t unroll(std::vector<double>& stamps, double origin, double step);

/// What was mended in a column of stamps.
struct MendedStamps {
  std::vector<std::size_t> samples;  ///< that were replaced
  std::size_t backwards = 0;         ///< of these: were below the stamp before
  std::size_t by_counter = 0;        ///< of these: put where the counter says
};
/// Replaces stamps that are no number or lie apart from those before and after. `counter` may be
/// empty.
[[nodiscard]] MendedStamps mend(std::vector<double>& stamps, double step, View<double> counter);

/// The rate at which the stamps are k / rate to the last bit; 0 if there is none.
[[nodiscard]] double uniform_rate_hz(View<double> stamps_s);

}  // namespace proofmass::io
