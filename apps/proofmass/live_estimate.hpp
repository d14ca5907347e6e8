#pragma once

#include <vector>

#include "live_view.hpp"
#include "proofmass/acquire/recorder.hpp"
#include "record_command.hpp"

namespace proofmass::app {

/// The analysis requested by --estimate, on calibrated live samples; announces its columns to the
/// view. Empty if none was requested. Throws Failure.
[[nodiscard]] acquire::MakeAnalysis make_estimate(const RecordCommand& command,
                                                  LiveView& view,
                                                  std::vector<Note>& notes);

}  // namespace proofmass::app
