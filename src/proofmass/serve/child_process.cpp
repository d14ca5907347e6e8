#include "proofmass/serve/child_process.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <optional>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace proofmass::serve {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> out;
  for (const std::string& word : words) out.push_back(const_cast<char*>(word.c_str()));
  out.push_back(nullptr);
  return out;
}

// Signals as a program expects them to begin with; its own group, so that Ctrl-C is not its too.
void set_attributes(posix_spawnattr_t& attributes) {
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
}

void connect(posix_spawn_file_actions_t& actions, int given, int standard, int mode) {
  if (given >= 0)
    posix_spawn_file_actions_adddup2(&actions, given, standard);
  else
    posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", mode, 0);
}

int spawn(const ChildCommand& command, int errors, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  set_attributes(attributes);
  posix_spawn_file_actions_addchdir_np(&actions, command.folder.c_str());
  connect(actions, command.input, STDIN_FILENO, O_RDONLY);
  connect(actions, command.output, STDOUT_FILENO, O_WRONLY);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  // Sockets among them, which would stay open as long as the program runs.
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  const int failed =
      posix_spawn(&pid, command.arguments.front().c_str(), &actions, &attributes,
                  pointers(command.arguments).data(), pointers(command.environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

// Cuts what arrives into lines, of which one that never ends is cut as well.
class LineCutter {
 public:
  explicit LineCutter(const std::function<void(std::string_view)>& take) : take_(take) {}
  void add(std::string_view bytes) {
    constexpr std::size_t longest = 4096;
    for (const char c : bytes) {
      if (c == '\n')
        finish();
      else if (line_.size() < longest)
        line_ += c;
    }
  }
  void finish() {
    if (!line_.empty()) take_(line_);
    line_.clear();
  }

 private:
  const std::function<void(std::string_view)>& take_;
  std::string line_;
};

ChildEnd end_of(int status) {
  if (WIFSIGNALED(status)) return {0, WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const ChildCommand& command) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return Error{Errc::unreadable, fmt::format("no pipe: {}", std::strerror(errno))};
  pid_t pid = -1;
  const int failed = spawn(command, ends[1], pid);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    return Error{Errc::unreadable, fmt::format("{}: cannot be started: {}",
                                               command.arguments.front(), std::strerror(failed))};
  }
  return ChildProcess(pid, ends[0], command.patience);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      errors_(std::exchange(other.errors_, -1)),
      patience_(other.patience_) {}

ChildProcess::~ChildProcess() {
  if (errors_ >= 0) ::close(errors_);
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

ChildEnd ChildProcess::follow(const std::function<void(std::string_view line)>& take,
                              const std::function<bool()>& cancelled) {
  constexpr int period_ms = 100;
  std::optional<Clock::time_point> asked;
  bool killed = false;
  LineCutter lines(take);
  std::array<char, 4096> piece{};
  bool is_open = true;
  while (true) {
    // poll() passes a negative descriptor over and sleeps.
    pollfd waiting{is_open ? errors_ : -1, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, period_ms);
    const ssize_t got = ready > 0 ? ::read(errors_, piece.data(), piece.size()) : -1;
    if (got > 0) lines.add({piece.data(), static_cast<std::size_t>(got)});
    if (got == 0) is_open = false;
    // The pipe may outlive the program in a process that it has started.
    int status = 0;
    if (got <= 0 && ::waitpid(pid_, &status, WNOHANG) == pid_) {
      lines.finish();
      ::kill(-pid_, SIGKILL);
      pid_ = -1;
      return end_of(status);
    }
    if (!asked && cancelled()) {
      asked = Clock::now();
      ::kill(-pid_, SIGTERM);
    }
    if (asked && !killed && Clock::now() - *asked > patience_) {
      killed = true;
      ::kill(-pid_, SIGKILL);
    }
  }
}

}  // namespace proofmass::serve
