#pragma once

#include <vector>

#include "input/rest_channels.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/report/drift/report.hpp"

// Several recordings as power-ups of one sensor.
namespace proofmass::app {

/// Sorts three recordings or more by time: by their first stamps if all have absolute time, else by
/// their names, in which numbers count by value (run2 before run10). A note reports a changed
/// order.
void put_in_time_order(std::vector<RestRecording>& recordings, std::vector<Note>& notes);

/// Compares the runs of each channel, in the order of the first recording; two recordings or fewer
/// are not a set. Channels that are not in all recordings, and refused runs, are omitted with a
/// note.
[[nodiscard]] std::vector<report::ChannelRuns> compare_recordings(
    const std::vector<RestRecording>& recordings,
    double since_switch_on_s,
    const Progress& progress,
    std::vector<Note>& notes);

}  // namespace proofmass::app
