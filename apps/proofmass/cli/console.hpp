#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"

// Standard error: notes, a progress bar on a terminal, and the error line.
namespace proofmass::app {

/// Installs handlers by which SIGINT, SIGTERM and SIGHUP end the process with status 130 and a
/// message, unless the parent process ignores them (nohup). Exceeding `ulimit -f` becomes a write
/// error instead of ending the process.
void watch_for_interrupts();

/// Runs work that must not be interrupted, such as writing a file. A signal received during the
/// work ends the process after the outermost nested call; a second signal has no effect, a third
/// ends the process at once.
void without_interruption(const std::function<void()>& work);

/// Marks the signal deferred by without_interruption() as the intended end: it is not reported as
/// an interruption.
void interruption_was_awaited();

/// A disconnected peer ends its connection instead of the process (SIGPIPE).
void ignore_broken_pipes();

/// True if without_interruption() defers a signal: the work should end.
[[nodiscard]] bool interruption_waits();

/// Prints warnings and bad notes; with --verbose all notes, with --quiet none. `where` is a prefix,
/// which may be empty.
void show_notes(const std::vector<Note>& notes, const std::string& where, const OutputFlags& flags);

/// A progress bar on a terminal; none elsewhere or with --quiet. Cleared when the last copy is
/// destroyed. If PROOFMASS_PROGRESS is "lines": lines such as "progress 42 reading", for a parent
/// program.
[[nodiscard]] Progress progress_bar(const OutputFlags& flags);

/// Several lines on a terminal that are redrawn in place; nothing elsewhere or with --quiet.
/// Cleared by the destructor.
class Panel {
 public:
  explicit Panel(const OutputFlags& flags);
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  ~Panel();

  [[nodiscard]] bool is_shown() const { return shown_; }
  /// Lines are cut to the width of the terminal.
  void show(const std::vector<std::string>& lines);
  void wipe();

 private:
  bool shown_;
  std::size_t lines_ = 0;  ///< number of lines currently shown
};

/// A single line; nothing with --quiet.
void show_line(const std::string& line, const OutputFlags& flags);

/// "proofmass: MESSAGE".
void show_error(const std::string& message);

}  // namespace proofmass::app
