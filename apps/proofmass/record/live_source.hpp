#pragma once

#include "proofmass/acquire/recorder.hpp"
#include "record/command.hpp"

namespace proofmass::app {

/// What the environment says of libraries, of which PROOFMASS_NIDAQMX_LIB is NI's; an interruption
/// ends the wait for a source.
[[nodiscard]] acquire::OpenOptions open_options();

/// Opens the command's source as its flags say: --rate as a setting of the URI, --unit in place of
/// units that the source does not know; given up at an interruption.
[[nodiscard]] acquire::OpenSource source_opener(const RecordCommand& command);

}  // namespace proofmass::app
