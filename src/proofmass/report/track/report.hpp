#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/track.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A solution and its input.
struct TrackReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< notes of reading and preparation; the solution's are
                                    ///< added
  estimate::TrackOptions options;
  estimate::TrackSolution solution;
};

/// Displacement by each method, error budget, strokes, stops, consistency. Holds a reference to the
/// report, which must outlive it.
[[nodiscard]] Document describe(const TrackReport& report);

/// The whole time history as a recording with the columns time, position, position_std, velocity,
/// …; the content of `--output`. Contains the input only if that may not be acceleration.
[[nodiscard]] Recording track_series(const TrackReport& report);

}  // namespace proofmass::report
