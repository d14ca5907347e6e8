#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/track.hpp"

namespace proofmass::report {

/// A solution and what it was computed from.
struct TrackReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< of reading and preparing; the solution's own are added
  estimate::TrackOptions options;
  estimate::TrackSolution solution;
};

/// The document of `track`: docs/schema/track.schema.json.
[[nodiscard]] std::string track_json(const TrackReport& report);

/// The page: conclusion, key figures, notes, budget, plots, strokes, stops, consistency.
[[nodiscard]] std::string track_html(const TrackReport& report);

/// A screenful for a terminal, the budget first, without colour, closed by a newline.
[[nodiscard]] std::string track_text(const TrackReport& report);

/// "It ended 3.1 ± 4.6 mm from where it began; 10 strokes there and back, median 0.441 ± 0.012 m."
[[nodiscard]] std::string track_conclusion(const estimate::TrackSolution& solution);

/// The whole time line as a recording with the columns time, position, position_std, velocity, …:
/// what `--output` writes. Of readings that may be no accelerations it holds the readings alone.
[[nodiscard]] Recording track_series(const TrackReport& report);

}  // namespace proofmass::report
