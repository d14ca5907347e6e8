#pragma once

#include <vector>

#include "input/rest_channels.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/report/drift/report.hpp"

// Several recordings as power-ups of one sensor.
namespace proofmass::app {

/// Puts three recordings or more into the order in which they were made: by their first stamps
/// where all have an absolute time, else by their names, in which numbers count by value (run2
/// before run10). Says so in a note where that is not the order given.
void put_in_time_order(std::vector<RestRecording>& recordings, std::vector<Note>& notes);

/// Compares the runs of each channel, in the order of the first recording; two recordings or fewer
/// are no set. Channels that are not in all recordings, and runs that were refused, are left out
/// with a note.
[[nodiscard]] std::vector<report::ChannelRuns> compare_recordings(
    const std::vector<RestRecording>& recordings,
    double since_switch_on_s,
    const Progress& progress,
    std::vector<Note>& notes);

}  // namespace proofmass::app
