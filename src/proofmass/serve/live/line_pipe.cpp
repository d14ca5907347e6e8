#include "proofmass/serve/live/line_pipe.hpp"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <poll.h>
#include <unistd.h>

namespace proofmass::serve {

LinePipe::LinePipe(int descriptor, std::size_t most_bytes)
    : descriptor_(descriptor), most_bytes_(most_bytes) {}

void LinePipe::write(std::string_view line) {
  if (is_broken_) return;
  if (kept_.size() + line.size() + 1 > most_bytes_) flush();
  if (kept_.size() + line.size() + 1 > most_bytes_) {
    ++left_out_;
    return;
  }
  kept_ += line;
  kept_ += '\n';
  flush();
}

void LinePipe::flush() {
  while (!kept_.empty() && pass_on(0)) {
  }
}

void LinePipe::drain(int patience_ms) {
  while (!kept_.empty() && pass_on(patience_ms)) {
  }
}

/// poll() reports a pipe as writable if PIPE_BUF bytes fit (pipe(7)): a write of as many does not
/// wait, whether or not the descriptor, which others may share, is non-blocking.
bool LinePipe::pass_on(int patience_ms) {
  pollfd waiting{descriptor_, POLLOUT, 0};
  if (::poll(&waiting, 1, patience_ms) <= 0) return false;
  const std::size_t piece = std::min<std::size_t>(kept_.size(), PIPE_BUF);
  const ssize_t written = ::write(descriptor_, kept_.data(), piece);
  if (written > 0) {
    kept_.erase(0, static_cast<std::size_t>(written));
    return true;
  }
  if (errno != EINTR && errno != EAGAIN) {
    is_broken_ = true;
    kept_.clear();
  }
  return false;
}

}  // namespace proofmass::serve
