#pragma once

#include <array>
#include <memory>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/live_track.hpp"
#include "proofmass/estimate/track_test_support.hpp"

namespace proofmass::estimate {

/// Columns of live_track.hpp.
enum LiveTrackColumn : std::size_t {
  live_position,
  live_position_std,
  live_velocity,
  live_velocity_std,
  live_smoothed_time,
  live_smoothed_position,
  live_smoothed_position_std,
  live_resting
};

inline LiveTrackOptions live_options() {
  LiveTrackOptions options;
  options.sensor = {"acc", 0, 1, 2};
  options.scale_std = 0.0;
  return options;
}

inline Block block_of(const TrackSensor& sensor, std::size_t first, std::size_t count) {
  Block block{first, {}, View<double>(sensor.time_s).subspan(first, count)};
  for (const std::vector<double>& axis : sensor.accel_mps2)
    block.channels.push_back(View<double>(axis).subspan(first, count));
  return block;
}

struct LiveTrackRun {
  Rows rows;
  std::vector<Note> notes;

  [[nodiscard]] double last(LiveTrackColumn column) const { return rows.channels[column].back(); }
  [[nodiscard]] bool says(const std::string& words) const {
    for (const Note& note : notes)
      if (note.text.find(words) != std::string::npos) return true;
    return false;
  }
};

/// Feeds the data in blocks of `piece` samples.
inline LiveTrackRun run_live(const TrackSensor& sensor,
                             const LiveTrackOptions& options,
                             std::size_t piece = 50) {
  LiveTrackRun run;
  auto live = live_track(options);
  if (!live) return run;
  const std::size_t size = sensor.time_s.size();
  bool fine = true;
  for (std::size_t k = 0; k < size; k += piece)
    fine = fine && (*live)->add(block_of(sensor, k, std::min(piece, size - k)), run.rows);
  fine = fine && (*live)->finish(run.rows);
  run.notes = (*live)->take_notes();
  if (!fine) run.rows.clear();
  return run;
}

}  // namespace proofmass::estimate
