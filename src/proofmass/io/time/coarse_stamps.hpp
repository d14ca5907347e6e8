#pragma once

#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Stamps in whole ticks of a clock that ticks about once per sample: intervals of one tick and
/// occasionally of two (or none).
struct CoarseStamps {
  double tick = 0.0;
  double step = 0.0;  ///< actual sample period of the sensor
  double band = 0.0;  ///< TimeBase::band_s, in the unit of the stamps
};

/// Distinguishes rounding from missing rows by the regularity of the odd intervals. With rounding,
/// every run of a given number of rows contains the same number of them, to within one; missing or
/// repeated rows are as irregular as a Poisson process, or more.
///
/// - Rounding is accepted if chance would give such regularity in one case of 10 000.
/// - nullopt if fewer than 99 % of the intervals are whole multiples of the median, if more than
///   half of the intervals are odd, or if the odd ones are too few to decide.
/// - nullopt also if fewer than 12 % repeat the previous stamp and the tick is more than one unit
///   of the last digit (rows written twice), or if the tick is within 5 % of the period and fewer
///   than 95 % of the runs of rows agree.
///
/// steps: the positive intervals, of any of the stamps.
[[nodiscard]] std::optional<CoarseStamps> find_coarse_stamps(View<double> stamps,
                                                             const std::vector<double>& steps,
                                                             double median_step);

/// The width of the band filled by bursts of rows whose stamp is close to that of their packet:
/// twice the width that contains nine in ten runs of rows. 0 for fewer than 32 rows.
[[nodiscard]] double band_of_bursts(View<double> stamps, double step);

/// A line through bursts of rows, and the band that they fill.
struct BurstLine {
  double step = 0.0, band = 0.0;
};

/// The line on which no row is missing, if a band of this width has holes that the stamps do not
/// require: about that line they scatter as little (within 30 %). A computer that was busy for an
/// unusually long time and then caught up resembles a hole and its compensation.
[[nodiscard]] std::optional<BurstLine> line_without_holes(View<double> stamps,
                                                          double step,
                                                          double band);

/// The sample period from a straight line through the stamps against their sample numbers,
/// including missing ones: by signal::StampBand, or by single intervals if `band` is 0. Returns
/// `step` if the two differ by more than 2 %, with a band 5 %.
[[nodiscard]] double step_by_line(View<double> stamps, double step, double band);

}  // namespace proofmass::io
