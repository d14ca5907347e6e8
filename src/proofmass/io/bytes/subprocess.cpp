#include "proofmass/io/bytes/subprocess.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <new>
#include <poll.h>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "proofmass/io/bytes/subprocess_frames.hpp"
#include "proofmass/io/unnamed_file.hpp"

namespace proofmass::io {
namespace {

// ---- the child's side ----

bool write_frame(int descriptor, FrameKind kind, std::span<const char> bytes) {
  const FrameHeader header{kind, static_cast<std::uint32_t>(bytes.size())};
  const auto head = std::bit_cast<std::array<char, sizeof header>>(header);
  return write_all(descriptor, head) && write_all(descriptor, bytes);
}

void write_error(int descriptor, Errc code, std::string_view message) {
  std::string text(1, static_cast<char>(code));
  text += message.substr(0, 4000);
  write_frame(descriptor, FrameKind::error, text);
}

/// Bytes mapped now; 0 if the system does not report it.
std::size_t mapped_bytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  std::size_t pages = 0;
  if (std::fscanf(file, "%zu", &pages) != 1) pages = 0;
  std::fclose(file);
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_AS) what, std::size_t soft, std::size_t hard) {
  struct rlimit now{};
  if (::getrlimit(what, &now) != 0) return;
  const struct rlimit wanted{std::min<rlim_t>(soft, now.rlim_max),
                             std::min<rlim_t>(hard, now.rlim_max)};
  ::setrlimit(what, &wanted);
}

void shut_in(const ChildLimits& limits, int parent) {
  for (int number = 1; number < 32; ++number) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int stream = 0; stream < 3; ++stream)
    if (nowhere < 0 || ::dup2(nowhere, stream) < 0) ::close(stream);
  // A sanitizer maps terabytes in advance: only additional memory can be limited.
  if (const std::size_t mapped = mapped_bytes(); mapped > 0)
    limit(RLIMIT_AS, mapped + limits.memory_bytes, mapped + limits.memory_bytes);
  limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);
}

[[noreturn]] void be_child(int out, const ChildWork& work, const ChildLimits& limits) {
  const ByteSink sink = [out](std::span<const char> bytes) {
    while (!bytes.empty()) {
      const auto piece = bytes.first(std::min(bytes.size(), most_frame_bytes));
      if (!write_frame(out, FrameKind::data, piece)) return false;
      bytes = bytes.subspan(piece.size());
    }
    return true;
  };
  try {
    const Status done = work(sink);
    if (done)
      write_frame(out, FrameKind::end, {});
    else
      write_error(out, done.error().code, done.error().message);
  } catch (const std::bad_alloc&) {
    write_error(out, Errc::unsupported,
                fmt::format("needs more than {} MiB to unpack", limits.memory_bytes >> 20));
  } catch (...) {
    write_error(out, Errc::corrupt, "cannot be unpacked");
  }
  ::_exit(0);
}

// ---- the parent's side ----

/// The error for a child that did not complete its message.
Error how_it_ended(int status, const ChildLimits& limits) {
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGXCPU || number == SIGKILL)
    return {
        Errc::corrupt,
        fmt::format("takes more than {} s to unpack: it is damaged, or was made to", limits.cpu_s)};
  if (number == SIGINT || number == SIGTERM || number == SIGHUP)
    return {Errc::unreadable, "reading was interrupted"};
  return {Errc::corrupt, "is damaged: the library that unpacks it stopped"};
}

}  // namespace

/// The read end of a pipe and the child process; both are closed by the destructor.
class Subprocess::Process {
 public:
  Process(pid_t process, int pipe, const ChildLimits& limits)
      : process_(process), pipe_(pipe), limits_(limits), message_([this](std::span<char> into) {
          auto count = read(into);
          broke_off_ = broke_off_ || (count && *count == 0);
          return count;
        }) {}
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() { end(true); }

  Result<std::span<const char>> next() {
    if (process_ <= 0) return std::span<const char>{};
    auto bytes = message_.next();
    if (bytes && !bytes->empty()) return bytes;
    const int status = end(!bytes && !broke_off_);
    if (!bytes && broke_off_) return how_it_ended(status, limits_);
    return bytes;
  }

 private:
  /// Waits for the process, optionally killing it; its status, if still available.
  int end(bool by_force) {
    int status = 0;
    if (process_ <= 0) return status;
    if (by_force) ::kill(process_, SIGKILL);
    ::close(pipe_);
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = 0;
    return status;
  }

  Result<std::size_t> read(std::span<char> into) const {
    for (;;) {
      struct pollfd waiting{pipe_, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, static_cast<int>(limits_.silence_s) * 1000);
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0)
        return Error{Errc::corrupt, fmt::format("gives nothing within {} s: it is damaged, or its "
                                                "disk does not answer",
                                                limits_.silence_s)};
      const ssize_t count = ::read(pipe_, into.data(), into.size());
      if (count < 0 && errno == EINTR) continue;
      return count < 0 ? 0 : static_cast<std::size_t>(count);
    }
  }

  pid_t process_;
  int pipe_;
  ChildLimits limits_;
  MessageReader message_;
  bool broke_off_ = false;
};

Subprocess::Subprocess(std::unique_ptr<Process> process) : process_(std::move(process)) {}
Subprocess::Subprocess(Subprocess&&) noexcept = default;
Subprocess& Subprocess::operator=(Subprocess&&) noexcept = default;
Subprocess::~Subprocess() = default;

Result<std::span<const char>> Subprocess::next() {
  return process_->next();
}

Result<Subprocess> Subprocess::start(const ChildWork& work, const ChildLimits& limits) {
  const auto failed = [](const char* what) {
    return system_failure(fmt::format("cannot be unpacked: {}", what));
  };
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failed("no pipe");
  ::fcntl(ends[1], F_SETPIPE_SZ, static_cast<int>(most_frame_bytes));  // if refused, only slower
  const pid_t self = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) {
    // Avoids the standard streams, which may include the pipe.
    const int out = ::fcntl(ends[1], F_DUPFD_CLOEXEC, 3);
    ::close(ends[0]);
    ::close(ends[1]);
    if (out < 0) ::_exit(1);
    shut_in(limits, self);
    be_child(out, work, limits);
  }
  ::close(ends[1]);
  if (process < 0) {
    const Error error = failed("no process");
    ::close(ends[0]);
    return error;
  }
  return Subprocess(std::make_unique<Process>(process, ends[0], limits));
}

Status run_in_child(const ChildWork& work, const ByteTaker& take, const ChildLimits& limits) {
  auto started = Subprocess::start(work, limits);
  if (!started) return started.error();
  Subprocess child = std::move(started).value();
  for (;;) {
    const auto bytes = child.next();
    if (!bytes) return bytes.error();
    if (bytes->empty()) return Done{};
    if (const Status taken = take(*bytes); !taken) return taken;
  }
}

}  // namespace proofmass::io
