#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"

// Standard error: notes, a progress bar where someone watches, and the one line of an error.
namespace proofmass::app {

/// From here on SIGINT ends the process with 130 and SIGTERM with 143, each with a line that says
/// so.
void watch_for_interrupts();

/// Does what must not be broken off half way, such as writing a file. A signal that comes meanwhile
/// ends the process behind it; a second one at once.
void without_interruption(const std::function<void()>& work);

/// Prints warnings and faults; with --verbose all notes; with --quiet none. `where` goes before
/// each, and may be empty.
void show_notes(const std::vector<Note>& notes, const std::string& where, const OutputFlags& flags);

/// A bar on a terminal, nothing elsewhere or with --quiet. It is wiped away with the last copy.
[[nodiscard]] Progress progress_bar(const OutputFlags& flags);

/// "proofmass: MESSAGE".
void show_error(const std::string& message);

}  // namespace proofmass::app
