#pragma once

#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/track.hpp"

// Where the sensor was at rest.
namespace proofmass::estimate {

struct Stops {
  std::vector<signal::Rest> rests;  ///< ascending, disjoint
  bool by_quietness = false;
  std::string why_none{};
  std::size_t cruises = 0, plateaus = 0;  ///< removed: constant speed, constant acceleration
  bool too_many_in_doubt = false;         ///< whether they are rests is ambiguous for too many
  /// Duration of the quiet intervals of which the rests are parts, without plateaus removed.
  double quiet_s = 0.0;
  bool only_ends = false;  ///< all of the recording is as quiet as rest, and may hide a motion
};

/// The rests of signal::find_rests(); if there are none, intervals that are quiet relative to the
/// motion, since fused acceleration data have no sensor noise of their own. If the user states the
/// static intervals, only those.
[[nodiscard]] Stops find_stops(View<View<double>> axes,
                               View<double> time_s,
                               double rate_hz,
                               const TrackOptions& options);

/// The parts of rests with a constant level. signal::find_rests() estimates the drift of a level at
/// rest from most of the quiet intervals; if most of them are slow motion, that is the motion's
/// acceleration. Here the level may change between blocks of a quarter of a second by five times
/// the value of the steadiest fiftieth of all rests, or of white noise; of the parts of one rest,
/// those with the most frequent level count. A drifting level costs a rest, never a motion.
///
/// Next to motion a rest is shortened by the time in which a slow onset is hidden in the noise. An
/// interval between motions of which less than `shortest_s` then remains is no rest.
[[nodiscard]] std::vector<signal::Rest> steady_parts(View<View<double>> axes,
                                                     const std::vector<signal::Rest>& rests,
                                                     double rate_hz,
                                                     double shortest_s);

/// Intervals of half-second windows whose measurements scatter by less than four times the quietest
/// tenth and whose means stay within that; none unless the record is five times as loud elsewhere.
[[nodiscard]] std::vector<signal::Rest> quiet_stretches(View<View<double>> axes,
                                                        double rate_hz,
                                                        double shortest_s);

}  // namespace proofmass::estimate
