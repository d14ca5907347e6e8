#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/estimate/track/motion.hpp"

// Decides which quiet intervals are rests.
namespace proofmass::estimate {

/// A sensor at constant speed measures the same as at rest, and one at constant acceleration is as
/// quiet.
enum class QuietStretch { rest, cruise, plateau };

struct StopHypothesis {
  std::vector<QuietStretch> stretches;  ///< one for each of the signal's stops
  double probability = 1.0;
};

/// Removes stops whose level has another norm than the others': the norm of gravity does not depend
/// on the orientation, so the sensor accelerates there. Three axes with gravity only.
void drop_plateaus(TrackSignal& signal);

/// Hypotheses for the stops, by falling probability; none below 1e-3. One hypothesis, all rests,
/// unless more than a quarter of the speed remains at some stop, and more than five times what the
/// noise at rest explains.
///
/// - Likelihood: of all closure velocities and levels, with the errors of motion integrated out as
///   in motion_error(). A cruise between two rests makes one closure velocity and the next cancel;
///   a tilt or a jump of the bias does not.
/// - Prior: the first and the last interval are rests 999 times in 1000; the share of the others
///   that are none has a beta distribution with mean 0.1. A cruise has a speed of about 0.03, 0.3,
///   3 or 30 m/s, a plateau an acceleration of about 0.05 or 0.5 m/s²; either is usually, and a
///   rest seldom, louder than the quietest interval. A motion between two rests whose highest speed
///   is what remains at its end is a tilt without motion, one in five.
/// - A plateau within 2° of the interval before it may be a rest on a place that is not level: the
///   hypothesis with a rest there has at least a tenth of its probability.
/// - Constant speed of the frame is not distinguishable from rest: only these priors separate a
///   recording that ends in motion from one that began in motion.
///
/// Absent if more than sixteen intervals are ambiguous. Cost: 343 passes over the knots for each
/// combination tried, four times with a cruise: 2n + 1 for each step of the climb and 2n² at its
/// end, with n ambiguous intervals.
[[nodiscard]] std::vector<StopHypothesis> stop_hypotheses(const TrackSignal& signal,
                                                          const AxisRun& run,
                                                          const std::vector<Closure>& closures);

}  // namespace proofmass::estimate
