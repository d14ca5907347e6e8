#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Samples missing from a recording.
struct Hole {
  std::size_t before = 0;  ///< the first sample after the hole
  std::size_t missing = 0;
};

/// A recording's samples as an evenly sampled series: consecutive samples are one period apart,
/// except at the holes.
struct EvenGrid {
  double rate_hz = 0.0;          ///< sample rate of the grid
  std::size_t recorded = 0;      ///< samples present
  std::size_t missing = 0;       ///< grid points without a sample
  std::vector<Hole> holes;       ///< ascending
  double relative_jitter = 0.0;  ///< std of the intervals that are not holes, in periods
};

/// Positions of a recording's samples on an even grid.
///
/// - Jitter is ignored. An interval longer than 1.5 nominal periods is a hole of round(interval ·
///   rate) − 1 samples, unless the eight samples on either side compensate for it, as they do when
///   only the host's stamp was late, or as many later ones as it is long, as they do when the host
///   stalled.
/// - Where single intervals are not conclusive (TimeBase::band_s), StampBand determines where
///   samples are missing.
/// - The rate is the nominal one. With stamps (none backwards by more than a period) it is that of
///   the grid over their duration, if the two agree within 2 %.
///
/// Errors: invalid_argument (no rate known), corrupt (the grid would have more than four times as
/// many points as there are samples).
/// Cost: O(N). For a recording in blocks: RunningEvenGrid.
[[nodiscard]] Result<EvenGrid> even_grid(const TimeBase& time, std::size_t samples);

/// The values of a channel on the grid: NaN in the holes and for implausible values (is_plausible).
/// Expects grid.recorded values; without holes they are not copied.
[[nodiscard]] Samples on_even_grid(Samples values, const EvenGrid& grid);

/// Where single stamps are not conclusive (TimeBase::band_s: rows in bursts, stamps rounded to
/// about one sample period), the same recording with the even times of its grid, missing samples
/// counted; any other recording unchanged. The median stamp keeps its time on the file's clock.
[[nodiscard]] Recording with_even_stamps(Recording recording);

/// Where the computer stalled and stamped the rows of that time late, all at once, the same
/// recording with these rows evenly between the one before and the first that is on time again,
/// missing samples counted. Only for regular stamps: half of the intervals are within a fourth of
/// the period. A note says how many rows; any other recording is unchanged.
[[nodiscard]] Recording without_late_stamps(Recording recording);

}  // namespace proofmass::signal
