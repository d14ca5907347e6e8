#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/estimate/track_motion.hpp"

// Which of the quiet stretches are rests. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// A sensor at constant speed reads as at rest does, and one at constant acceleration is as quiet.
enum class QuietStretch { rest, cruise, plateau };

struct StopHypothesis {
  std::vector<QuietStretch> stretches;  ///< one for each of the signal's stops
  double probability = 1.0;
};

/// Takes out of the stops those whose level is longer or shorter than that of the others: gravity
/// is as long in every position, so the sensor accelerates there. Three axes with gravity in them
/// only.
void drop_plateaus(TrackSignal& signal);

/// What the stops may be, by falling probability; none below 1e-3. One hypothesis, all rests,
/// unless at some stop more than a quarter of the speed is left over.
///
/// Compared are the likelihoods of all velocities left over and all levels, the errors of motion
/// integrated out as in motion_error(): a cruise between two rests makes one velocity that was left
/// over and the next cancel, a tilt or a jump of the bias does not. Prior: a stretch between others
/// is a rest nine times in ten, the first and the last 999 times in 1000; a cruise has a speed of
/// about 0.3, 3 or 30 m/s; it is mostly, and a rest seldom, louder than the quietest stretch. A
/// frame that moves at constant speed is exactly one at rest: only these priors tell a recording
/// that ends under way from one that began so. None where more than sixteen stretches are in doubt.
/// Cost: 343 passes over the knots for each combination tried, three times with a cruise: n + 1 for
/// each step of the climb and n²/2 at its end, with n stretches in doubt.
[[nodiscard]] std::vector<StopHypothesis> stop_hypotheses(const TrackSignal& signal,
                                                          const AxisRun& run,
                                                          const std::vector<Closure>& closures);

}  // namespace proofmass::estimate
