#include "record/stream.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

#include "cli/exit_status.hpp"

namespace proofmass::app {
namespace {

// A descriptor of our own for standard output; what others print goes nowhere.
int take_standard_output() {
  const int own = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (own < 0 || nowhere < 0 || ::dup2(nowhere, STDOUT_FILENO) < 0)
    throw Failure(failed, std::string("--stream: standard output: ") + std::strerror(errno));
  ::close(nowhere);
  return own;
}

}  // namespace

RecordStream::RecordStream()
    : descriptor_(take_standard_output()),
      pipe_(descriptor_),
      lines_([this](std::string_view line) { pipe_.write(line); }) {}

RecordStream::~RecordStream() {
  constexpr int patience_ms = 1000;
  pipe_.drain(patience_ms);
  ::close(descriptor_);
}

void RecordStream::opened(const Recording& head, const std::string& file) {
  lines_.opened(head, file);
  monitor_ = std::make_unique<serve::LiveMonitor>(head);
}

void RecordStream::samples(const Block& block) {
  lines_.samples(block, serve::LiveLines::Clock::now());
  if (monitor_) monitor_->add(block);
}

void RecordStream::guide(const std::function<std::string()>& picture, bool is_last) {
  constexpr std::chrono::milliseconds period{200};
  const auto now = serve::LiveLines::Clock::now();
  if (!is_last && now - guided_ < period) return;
  guided_ = now;
  pipe_.write(serve::live_line("guide", picture()));
}

void RecordStream::refresh() {
  lines_.refresh(serve::LiveLines::Clock::now());
  if (monitor_)
    for (const std::string& line : monitor_->take()) pipe_.write(line);
  pipe_.flush();
}

void RecordStream::ended(const RecordSummary& summary) {
  monitor_.reset();
  lines_.ended(summary);
}

}  // namespace proofmass::app
