#pragma once

#include "proofmass/acquire/recorder.hpp"
#include "record/command.hpp"

namespace proofmass::app {

/// Options from the environment, with NI's library in PROOFMASS_NIDAQMX_LIB; an interruption ends
/// the wait for a source.
[[nodiscard]] acquire::OpenOptions open_options();

/// Opens the command's source according to its flags: --rate becomes a setting of the URI, --unit
/// replaces unknown units; stops at an interruption.
[[nodiscard]] acquire::OpenSource source_opener(const RecordCommand& command);

}  // namespace proofmass::app
