#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"

// Values of a sensor that are no measurements: at an end of its range, or stuck.
namespace proofmass::signal {

/// Whether `run` equal values, next to which the signal changes by `slope` per sample towards them,
/// are too many for a crest in quantisation steps: that is flat for L samples only if the slope is
/// below 8 / L steps. A run counts up to 16, since beyond that a motion may end softly at rest.
[[nodiscard]] inline bool is_cut_off(std::size_t run, double slope, double step) {
  constexpr std::size_t longest = 16;
  constexpr double of_a_crest = 7.96;  // 8, less rounding
  return slope * static_cast<double>(std::min(run, longest)) > of_a_crest * step;
}

/// Ends of a channel's range that the signal ran into.
struct RangeEnds {
  std::optional<double> low, high;  ///< in the channel's unit

  [[nodiscard]] bool reached() const { return low || high; }
};

/// The lowest or highest value of a sensor's axis, if it is an end of the range:
///
/// - it occurs three times or more in a row, reached and left more steeply than a crest in
///   quantisation steps would be, either while another axis moves, since a sensor at rest may stay
///   at its extreme as well, or eight times and more on an axis whose noise changes all other
///   values;
/// - it occurs eight times as often as each of its neighbours, while another axis changes and noise
///   of two quantisation steps or more changes all other values of this one; or
/// - audit() finds a rail there (Clipping::rail), and it is not merely the level at rest: of at
///   least half the largest magnitude, or a fifth of the range away from the median.
///
/// `others`: further axes of the same rigid body, sample by sample. Units do not matter.
[[nodiscard]] RangeEnds range_ends(const Channel& axis, const std::vector<View<double>>& others);

/// Makes the values of these channels, axes of sensors on one rigid body, at an end of their range
/// NaN, since the true ones may lie anywhere beyond it. Returns a warning for each channel that has
/// any, with their number, the ends and the first time. `witnesses`: channels of other quantities
/// that change when these do.
std::vector<Note> drop_saturated(const std::vector<std::size_t>& channels,
                                 Recording& recording,
                                 const std::vector<std::size_t>& witnesses = {});

/// As drop_saturated(), for what counts at rest: with half a second before and after, since the
/// mean of noise that is cut off at one side is biased; and only channels that are at an end for
/// half a second or more in all, since a motion between rests may well exceed the range.
std::vector<Note> drop_saturated_rests(const std::vector<std::size_t>& channels,
                                       Recording& recording);

/// Makes the values of each sensor, of one to three channels, NaN where they are stuck
/// (stuck_intervals()), but for the first of them; also where another sensor of the same logger is
/// stuck and none of its own axes changes. Returns a warning for each sensor that has any.
std::vector<Note> drop_stuck(const std::vector<std::vector<std::size_t>>& sensors,
                             Recording& recording);

}  // namespace proofmass::signal
