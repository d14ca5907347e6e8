#pragma once

#include <cstddef>
#include <optional>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Where the upper side of a channel's range ends, in a way that the extreme value alone does not
/// show.
struct RangeLimit {
  enum class Kind {
    hard,  ///< cut off at a level, and noise was added behind it
    soft,  ///< bent towards a level, as by tanh
    flat,  ///< flatter than an oscillation's, but each crest alike: soft, or the shape of the
           ///< motion
  };
  Kind kind = Kind::hard;
  double level = 0.0;       ///< hard: of the limit; else: beyond which the crests are bent
  std::size_t samples = 0;  ///< at the limit, or beyond the level
};

/// Looks for a limit above the signal: find_hard_limit(), then find_soft_limit(). NaN in the
/// series ends a stretch of samples. A lower limit is that of the negated series.
[[nodiscard]] std::optional<RangeLimit> find_upper_limit(View<double> series);

/// A cut-off level with noise behind it. Such a signal runs into the level with a slope that does
/// not decay, stays at it within the noise for as long as it would have been above, and leaves it
/// as it came, many times and always at this level. What else stays at its highest level is told
/// apart by this: a rest or a square motion jumps, decays into its level, comes and goes by
/// different slopes, would have risen to several times the range, or stays at other levels too.
/// Where every visit looks alike the signal below the level has to be the sine of which the part
/// above the level is missing, as a motion with flat crests repeats as well; where they differ,
/// the flanks must not be straight, as those of a ramp between two stops are.
[[nodiscard]] std::optional<RangeLimit> find_hard_limit(View<double> series);

/// A level that the signal is bent towards. By Rice's formula the time spent about a level and the
/// number of crossings give the slope there. The mean square of the slope at height u falls from
/// the middle to the highest crest A no faster than that of one oscillation, as 1 − u²/A²; behind
/// a memoryless limiter y = g(x) it falls as g'(x)², though many crests still reach there. Where
/// every crest looks alike that may be the shape of the motion as well: `flat`.
/// Source: S. O. Rice, Bell System Technical Journal 24 (1945) 46, section 3.3, for crossings.
[[nodiscard]] std::optional<RangeLimit> find_soft_limit(View<double> series);

}  // namespace proofmass::signal
