#include "cli/console.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/plain_text.hpp"
#include "host.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {
namespace {

// State that a signal handler may access.
volatile std::sig_atomic_t held_back = 0;    // nesting depth of work that must not be interrupted
volatile std::sig_atomic_t signal_seen = 0;  // signal received during that work
volatile std::sig_atomic_t signal_count = 0;
volatile std::sig_atomic_t was_awaited = 0;
volatile std::sig_atomic_t bar_shown = 0;

constexpr std::string_view wipe = "\r\033[K";

// Calls only async-signal-safe functions (POSIX).
[[noreturn]] void end_interrupted() {
  constexpr int status = 130;
  constexpr std::string_view text = "proofmass: interrupted\n";
  // A failed write does not change the exit.
  [[maybe_unused]] ssize_t written = 0;
  if (bar_shown != 0) written = write(STDERR_FILENO, wipe.data(), wipe.size());
  if (was_awaited == 0) written = write(STDERR_FILENO, text.data(), text.size());
  _exit(status);
}

extern "C" void on_signal(int signal_number) {
  // Tolerates a double Ctrl-C, since closing a file takes time.
  constexpr int most_held_back = 2;
  signal_count = signal_count + 1;
  if (held_back == 0 || signal_count > most_held_back) end_interrupted();
  signal_seen = signal_number;
}

void watch_for(int signal_number) {
  struct sigaction action{};
  if (sigaction(signal_number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) return;
  action.sa_handler = on_signal;
  action.sa_flags = 0;
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

bool on_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 &&
         (terminal == nullptr || std::string_view(terminal) != "dumb");
}

// Source: https://no-color.org: any non-empty value disables colour.
bool in_colour() {
  const char* no_colour = std::getenv("NO_COLOR");
  return on_terminal() && (no_colour == nullptr || *no_colour == '\0');
}

std::string painted(std::string_view text, int colour) {
  return in_colour() ? fmt::format("\033[{}m{}\033[0m", colour, text) : std::string(text);
}

void print(const std::string& message) {
  const std::string text = terminal_text(message);
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::size_t terminal_width() {
  constexpr std::size_t usual = 80;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return usual;
  return size.ws_col;
}

// The beginning of the line, at most `width` columns; each code point counts as one column.
std::string cut(const std::string& line, std::size_t width) {
  std::size_t letters = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool begins_letter = (static_cast<unsigned char>(line[i]) & 0xC0U) != 0x80U;
    if (begins_letter && letters++ == width) return line.substr(0, i);
  }
  return line;
}

// Moves the cursor to the beginning of the line `lines` above.
std::string above(std::size_t lines) {
  return lines == 0 ? "\r" : fmt::format("\r\033[{}A", lines);
}

// Redraws itself in place, and clears its line when destroyed.
class Bar {
 public:
  Bar() = default;
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;
  ~Bar() {
    if (shown_ >= 0) print(std::string(wipe));
    bar_shown = 0;
  }
  void show(std::string_view stage, double fraction) {
    constexpr int width = 30, steps = 10 * width;
    const int step =
        static_cast<int>(std::clamp(std::isfinite(fraction) ? fraction : 0.0, 0.0, 1.0) * steps);
    if (step == shown_ && stage == stage_) return;
    if (step < shown_ || stage != stage_) begin(stage);
    shown_ = step;
    bar_shown = 1;
    const int full = step * width / steps;
    const std::string line = fmt::format(
        "[{:=<{}}{: <{}}] {:3d} %  {}{}{}", "", full, "", width - full, 100 * step / steps,
        passes_ > 1 ? fmt::format("step {}: ", passes_) : "", stage, left_words(step, steps));
    print("\r\033[K" + cut(line, terminal_width() - 1));
  }

 private:
  using Clock = std::chrono::steady_clock;

  // Work in several passes fills the bar once per pass.
  void begin(std::string_view stage) {
    stage_ = stage;
    begun_ = Clock::now();
    ++passes_;
  }
  [[nodiscard]] std::string left_words(int step, int steps) const {
    constexpr double soonest_s = 2.0;  // earlier estimates are unreliable
    const double gone_s = std::chrono::duration<double>(Clock::now() - begun_).count();
    if (step == 0 || step == steps || gone_s < soonest_s) return {};
    const double left_s = gone_s * (steps - step) / step;
    return left_s < 90.0 ? fmt::format(", {:.0f} s left", std::ceil(left_s))
                         : fmt::format(", {:.0f} min left", std::ceil(left_s / 60.0));
  }

  int shown_ = -1, passes_ = 0;
  std::string stage_;
  Clock::time_point begun_;
};

// Requested by a parent program: PROOFMASS_PROGRESS=lines.
bool wants_progress_lines() {
  const char* wish = std::getenv("PROOFMASS_PROGRESS");
  return wish != nullptr && std::string_view(wish) == "lines";
}

// "progress 42 reading", once per hundredth of a stage.
Progress progress_lines() {
  struct Said {
    std::string stage;
    int percent = -1;
  };
  return [said = std::make_shared<Said>()](std::string_view stage, double fraction) {
    const int percent =
        static_cast<int>(100.0 * std::clamp(std::isfinite(fraction) ? fraction : 0.0, 0.0, 1.0));
    if (percent == said->percent && stage == said->stage) return;
    *said = {std::string(stage), percent};
    print(fmt::format("progress {} {}\n", percent, io::clean_text(stage)));
  };
}

}  // namespace

void watch_for_interrupts() {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) watch_for(signal_number);
  std::signal(SIGXFSZ, SIG_IGN);
}

void without_interruption(const std::function<void()>& work) {
  struct Hold {
    Hold() { held_back = held_back + 1; }
    ~Hold() { held_back = held_back - 1; }
  };
  {
    const Hold hold;
    work();
  }
  if (held_back == 0 && signal_seen != 0) end_interrupted();
}

void ignore_broken_pipes() {
  std::signal(SIGPIPE, SIG_IGN);
}

void interruption_was_awaited() {
  was_awaited = 1;
}

bool interruption_waits() {
  return signal_seen != 0;
}

void show_notes(const std::vector<Note>& notes,
                const std::string& where,
                const OutputFlags& flags) {
  constexpr int yellow = 33, red = 31, grey = 90;
  if (flags.host) {
    for (const Note& note : notes) flags.host->notes.push_back(note.at(where));
    return;
  }
  if (flags.quiet) return;
  for (const Note& note : notes) {
    std::string word = painted("warning", yellow);
    if (note.severity == Severity::bad) word = painted("bad data", red);
    if (note.severity == Severity::info) word = painted("note", grey);
    if (note.severity == Severity::info && !flags.verbose) continue;
    print(fmt::format("{}: {}\n", word, io::clean_text(report::with_flags(note.at(where)))));
  }
}

Progress progress_bar(const OutputFlags& flags) {
  if (flags.host) return flags.host->progress;
  if (wants_progress_lines()) return progress_lines();
  const std::shared_ptr<Bar> bar =
      flags.quiet || !on_terminal() ? nullptr : std::make_shared<Bar>();
  return [bar](std::string_view stage, double fraction) {
    if (bar) bar->show(stage, fraction);
  };
}

Panel::Panel(const OutputFlags& flags) : shown_(!flags.quiet && on_terminal()) {}

Panel::~Panel() {
  wipe();
}

void Panel::show(const std::vector<std::string>& lines) {
  if (!shown_) return;
  const std::size_t width = terminal_width();
  std::string text = above(lines_);
  for (const std::string& line : lines) text += fmt::format("\033[K{}\n", cut(line, width));
  print(text + "\033[J");
  lines_ = lines.size();
}

void Panel::wipe() {
  if (lines_ > 0) print(above(lines_) + "\033[J");
  lines_ = 0;
}

void show_line(const std::string& line, const OutputFlags& flags) {
  if (!flags.quiet) print(line + "\n");
}

void show_error(const std::string& message) {
  constexpr int red = 31;
  print(fmt::format("{}: {}\n", painted("proofmass", red), io::clean_text(message)));
}

}  // namespace proofmass::app
