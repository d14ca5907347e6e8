#pragma once

#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/track.hpp"

// Where the sensor was at rest. Private to the module's track*.cpp.
namespace proofmass::estimate {

struct Stops {
  std::vector<signal::Rest> rests;  ///< ascending, apart
  bool by_quietness = false;
  std::string why_none{};
  std::size_t cruises = 0, plateaus = 0;  ///< taken out: at constant speed, constant acceleration
  bool too_many_in_doubt = false;         ///< whether they are rests
  bool only_ends = false;  ///< all of the recording is as quiet as rest, and may hide a motion
};

/// The rests of signal::find_rests(); where it finds none, stretches that are quiet against the
/// motion: what fuses an accelerometer with other sensors has no noise of its own to go by. Where
/// the user says when it was at rest, that alone.
[[nodiscard]] Stops find_stops(View<View<double>> axes,
                               View<double> time_s,
                               double rate_hz,
                               const TrackOptions& options);

/// The parts of rests whose level stays. signal::find_rests() measures how a level drifts at rest
/// by what most of the quiet stretches do; where most of them are slow motion, that is the motion's
/// acceleration. Here the level may wander between blocks of a quarter of a second by five times
/// what the steadiest fiftieth of all rests does, or white noise makes of it; of the parts of one
/// rest those count that have the level of most. A level that drifts by itself costs a rest, never
/// a motion.
[[nodiscard]] std::vector<signal::Rest> steady_parts(View<View<double>> axes,
                                                     const std::vector<signal::Rest>& rests,
                                                     double rate_hz,
                                                     double shortest_s);

/// Stretches of windows of half a second whose measurements scatter by less than four times what
/// the quietest tenth does and whose means stay within that; none unless the record is five times
/// as loud elsewhere.
[[nodiscard]] std::vector<signal::Rest> quiet_stretches(View<View<double>> axes,
                                                        double rate_hz,
                                                        double shortest_s);

}  // namespace proofmass::estimate
