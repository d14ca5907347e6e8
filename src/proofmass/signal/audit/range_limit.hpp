#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Upper limit of a channel's range that the extreme value alone does not reveal.
struct RangeLimit {
  enum class Kind {
    hard,  ///< clipped at a level, with noise added afterwards
    soft,  ///< compressed towards a level, as by tanh
    flat,  ///< flatter than a sine, but every crest alike: soft clipping, or the shape of the
           ///< motion
  };
  Kind kind = Kind::hard;
  double level = 0.0;       ///< hard: the limit; otherwise: where compression of the crests begins
  std::size_t samples = 0;  ///< at the limit, or beyond the level
};

/// Minimum, median and maximum of a series' finite values.
struct Extent {
  double low = 0.0, median = 0.0, high = 0.0;
  [[nodiscard]] double range() const { return high - low; }
};

/// Searches for a limit above the signal: find_hard_limit(), find_crowded_limit(), then
/// find_soft_limit(). NaN in the series ends a segment. A lower limit is that of the negated
/// series.
[[nodiscard]] std::optional<RangeLimit> find_upper_limit(View<double> series);

/// A clipping level with noise added afterwards. A clipped signal
///
/// - reaches the level with a slope that does not decay,
/// - stays at it, within the noise, for as long as it would have been above,
/// - leaves it with the same slope, many times and always at this level.
///
/// This distinguishes it from other signals that stay at their highest level: a rest or a square
/// motion jumps, decays into its level, arrives and leaves with different slopes, would have risen
/// to several times the range, or stays at other levels too.
///
/// If every visit looks alike, the signal below the level has to be the sine whose part above the
/// level is missing, because a motion with flat crests repeats as well. If the visits differ, the
/// flanks must not be straight, as those of a ramp between two stops are.
[[nodiscard]] std::optional<RangeLimit> find_hard_limit(View<double> series, const Extent& extent);

/// The same for a signal whose visits to the limit are shorter than the segments by which
/// find_hard_limit() finds it, as in broad-band vibration: values crowd at the limit, in many
/// visits of different length, at which the slopes do not decay, and which last as long as the
/// signal's own oscillation would have been above.
[[nodiscard]] std::optional<RangeLimit> find_crowded_limit(View<double> series,
                                                           const Extent& extent);

/// A level towards which the signal is compressed. By Rice's formula the time spent near a level
/// and the number of crossings give the slope there. The mean square of the slope at height u falls
/// from the middle to the highest crest A no faster than that of one oscillation, as 1 − u²/A²;
/// after a memoryless limiter y = g(x) it falls as g'(x)², although many crests still reach that
/// height. If every crest looks alike, this may also be the shape of the motion: `flat`.
/// Source: S. O. Rice, Bell System Technical Journal 24 (1945) 46, section 3.3, for crossings.
[[nodiscard]] std::optional<RangeLimit> find_soft_limit(View<double> series, const Extent& extent);

}  // namespace proofmass::signal
