#pragma once

#include <functional>
#include <vector>

#include "proofmass/acquire/recorder.hpp"
#include "record/command.hpp"
#include "record/live_view.hpp"

namespace proofmass::app {

/// The analysis requested by --estimate, on calibrated live samples; `columns` is called with its
/// columns. Empty if none was requested. Throws Failure.
[[nodiscard]] acquire::MakeAnalysis make_estimate(
    const RecordCommand& command,
    std::function<void(const std::vector<Channel>&)> columns,
    std::vector<Note>& notes);

}  // namespace proofmass::app
