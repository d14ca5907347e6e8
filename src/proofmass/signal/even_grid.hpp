#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Samples that are missing from a recording.
struct Hole {
  std::size_t before = 0;  ///< the first sample behind it
  std::size_t missing = 0;
};

/// A recording's samples as an evenly sampled series holds them: every sample one step behind the
/// one before, but for the holes.
struct EvenGrid {
  double rate_hz = 0.0;          ///< samples a second of the grid
  std::size_t recorded = 0;      ///< samples that there are
  std::size_t missing = 0;       ///< places in between that have none
  std::vector<Hole> holes;       ///< ascending
  double relative_jitter = 0.0;  ///< standard deviation of the steps that are no holes, in steps
};

/// Where the samples of a recording stand on an even grid. Jitter is ignored; a step longer than
/// 1.5 nominal ones is a hole of round(step · rate) − 1 samples, unless the eight samples on either
/// side make up for it, as they do where a computer was late with a stamp, not the sensor. Where
/// single steps do not tell (TimeBase::band_s), StampBand says where samples are missing. The rate
/// is the nominal one, or where there are stamps (and none runs backwards by more than a step) that
/// of the grid over their duration, if the two are within 2 %. Errors: invalid_argument (no rate
/// known), corrupt (the grid would have more than four times as many places as there are samples).
/// Cost: O(N). Of a recording in pieces: RunningEvenGrid.
[[nodiscard]] Result<EvenGrid> even_grid(const TimeBase& time, std::size_t samples);

/// The values of a channel on the grid: NaN in the holes, and for values that are no measurement
/// (is_plausible). Expects grid.recorded values.
[[nodiscard]] std::vector<double> on_even_grid(View<double> values, const EvenGrid& grid);

}  // namespace proofmass::signal
