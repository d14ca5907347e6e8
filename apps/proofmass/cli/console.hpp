#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"

// Standard error: notes, a progress bar where someone watches, and the one line of an error.
namespace proofmass::app {

/// From here on SIGINT, SIGTERM and SIGHUP end the process with 130 and a line that says so, unless
/// whoever started it has them ignored (nohup). A file that grows beyond the limit of `ulimit -f`
/// is a failure to write, not the end of the process.
void watch_for_interrupts();

/// Does what must not be broken off half way, such as writing a file. A signal that comes meanwhile
/// ends the process afterwards, after the outermost where they are nested; a second one changes
/// nothing, and a third ends it at once.
void without_interruption(const std::function<void()>& work);

/// The signal that without_interruption() holds back was the end that the user was asked for: no
/// line calls it an interruption.
void interruption_was_awaited();

/// A peer that goes away ends a connection, not the process.
void ignore_broken_pipes();

/// Whether a signal has come that without_interruption() holds back: the work is asked to end.
[[nodiscard]] bool interruption_waits();

/// Prints warnings and faults; with --verbose all notes; with --quiet none. `where` goes before
/// each, and may be empty.
void show_notes(const std::vector<Note>& notes, const std::string& where, const OutputFlags& flags);

/// A bar on a terminal, nothing elsewhere or with --quiet. It is wiped away with the last copy.
/// Where PROOFMASS_PROGRESS is "lines": lines such as "progress 42 reading", for a program that
/// runs this one.
[[nodiscard]] Progress progress_bar(const OutputFlags& flags);

/// Some lines on a terminal that are drawn anew in place; nothing elsewhere or with --quiet. Wiped
/// away when it goes.
class Panel {
 public:
  explicit Panel(const OutputFlags& flags);
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  ~Panel();

  [[nodiscard]] bool is_shown() const { return shown_; }
  /// Cut to the width of the terminal.
  void show(const std::vector<std::string>& lines);
  void wipe();

 private:
  bool shown_;
  std::size_t lines_ = 0;  ///< that stand there now
};

/// A line by itself; nothing with --quiet.
void show_line(const std::string& line, const OutputFlags& flags);

/// "proofmass: MESSAGE".
void show_error(const std::string& message);

}  // namespace proofmass::app
