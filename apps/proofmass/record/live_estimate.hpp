#pragma once

#include <vector>

#include "proofmass/acquire/recorder.hpp"
#include "record/command.hpp"
#include "record/live_view.hpp"

namespace proofmass::app {

/// What --estimate asks for, on samples as they come, calibrated; the view is told its columns.
/// Empty if it asks for nothing. Throws Failure.
[[nodiscard]] acquire::MakeAnalysis make_estimate(const RecordCommand& command,
                                                  LiveView& view,
                                                  std::vector<Note>& notes);

}  // namespace proofmass::app
