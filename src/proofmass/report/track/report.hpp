#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/track.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A solution and what it was computed from.
struct TrackReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< of reading and preparing; the solution's own are added
  estimate::TrackOptions options;
  estimate::TrackSolution solution;
};

/// Displacement by each method, error budget, strokes, stops, consistency. It refers to the report,
/// which must outlive it.
[[nodiscard]] Document describe(const TrackReport& report);

/// The whole time line as a recording with the columns time, position, position_std, velocity, …:
/// what `--output` writes. Where the data may not be
/// accelerations it has the data alone.
[[nodiscard]] Recording track_series(const TrackReport& report);

}  // namespace proofmass::report
