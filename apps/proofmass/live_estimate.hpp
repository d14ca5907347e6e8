#pragma once

#include <functional>
#include <vector>

#include "proofmass/acquire/recorder.hpp"
#include "record_command.hpp"

namespace proofmass::app {

/// What --estimate asks for, on samples as they come, calibrated; `columns` is called with its
/// columns. Empty if it asks for nothing. Throws Failure.
[[nodiscard]] acquire::MakeAnalysis make_estimate(
    const RecordCommand& command,
    std::function<void(const std::vector<Channel>&)> columns,
    std::vector<Note>& notes);

}  // namespace proofmass::app
