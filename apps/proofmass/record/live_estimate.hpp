#pragma once

#include <vector>

#include "proofmass/acquire/recorder.hpp"
#include "record/command.hpp"
#include "record/live_view.hpp"

namespace proofmass::app {

/// The analysis requested by --estimate, on calibrated live samples; announces its columns to the
/// view. Empty if none was requested. Throws Failure.
[[nodiscard]] acquire::MakeAnalysis make_estimate(const RecordCommand& command,
                                                  LiveView& view,
                                                  std::vector<Note>& notes);

}  // namespace proofmass::app
