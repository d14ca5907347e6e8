#pragma once

#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Stamps in whole ticks of a clock that ticks about once a sample: steps of one tick and now and
/// then of two (or none).
struct CoarseStamps {
  double tick = 0.0;
  double step = 0.0;  ///< from one sample to the next as the sensor took them
  double band = 0.0;  ///< TimeBase::band_s, in the unit of the stamps
};

/// Told from stamps with missing rows by how even the odd steps are spread. Of stretches of equally
/// many rows each holds the same number of them, to within one, where rounding makes them; missing
/// or repeated rows are as irregular as Poisson's law has it, or more so. Rounding is believed
/// where chance would spread them so evenly in one case of 10 000. nullopt where the median step is
/// not what 99 % of the steps are whole multiples of, more than half of the steps are odd, or the
/// odd ones are too few to tell; nor where fewer than 12 % repeat the stamp before and the tick is
/// more than one unit of the figures (rows written twice). steps: those above zero, of any of the
/// stamps.
[[nodiscard]] std::optional<CoarseStamps> find_coarse_stamps(View<double> stamps,
                                                             const std::vector<double>& steps,
                                                             double median_step);

/// The width of the band that bursts of rows with a stamp near that of their packet fill: twice as
/// wide as what nine in ten stretches of rows stay within. 0 for fewer than 32 rows.
[[nodiscard]] double band_of_bursts(View<double> stamps, double step);

/// A line through bursts of rows, and the band about it that they fill.
struct BurstLine {
  double step = 0.0, band = 0.0;
};

/// The line on which no row is missing, where a band of this width has holes in it that the stamps
/// do not need: about that line they scatter as little (within 30 %). A computer that was busy for
/// longer than usual and then caught up looks like a hole and what makes up for it.
[[nodiscard]] std::optional<BurstLine> line_without_holes(View<double> stamps,
                                                          double step,
                                                          double band);

/// The step by a straight line through the stamps against their sample numbers, missing ones
/// counted: by signal::StampBand, or by single steps where `band` is 0. `step` itself where that is
/// off by more than 2 %.
[[nodiscard]] double step_by_line(View<double> stamps, double step, double band);

}  // namespace proofmass::io
