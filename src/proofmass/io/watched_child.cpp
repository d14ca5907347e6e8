#include "proofmass/io/watched_child.hpp"

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
#include <system_error>
#include <unistd.h>
#include <vector>

namespace proofmass::io {
namespace {

enum class FrameKind : std::uint32_t { data = 0x61746164, error = 0x6F727265, end = 0x20646E65 };

struct FrameHeader {
  FrameKind kind = FrameKind::end;
  std::uint32_t bytes = 0;
};

// ---- the child's side ----

bool write_all(int descriptor, const void* bytes, std::size_t count) {
  const char* from = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(descriptor, from, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    from += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

bool write_frame(int descriptor, FrameKind kind, std::span<const char> bytes) {
  const FrameHeader header{kind, static_cast<std::uint32_t>(bytes.size())};
  return write_all(descriptor, &header, sizeof header) &&
         write_all(descriptor, bytes.data(), bytes.size());
}

void write_error(int descriptor, Errc code, std::string_view message) {
  std::string text(1, static_cast<char>(code));
  text += message.substr(0, 4000);
  write_frame(descriptor, FrameKind::error, text);
}

/// Bytes that are mapped now; 0 where the system does not say.
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
  // A sanitizer maps terabytes beforehand: only what is added can be limited.
  if (const std::size_t mapped = mapped_bytes(); mapped > 0)
    limit(RLIMIT_AS, mapped + limits.memory_bytes, mapped + limits.memory_bytes);
  limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);
}

[[noreturn]] void be_child(int out,
                           const std::function<Status(const ByteSink&)>& work,
                           const ChildLimits& limits) {
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

/// A pipe's reading end and the process behind it; both are gone with it.
class Child {
 public:
  Child(pid_t process, int pipe) : process_(process), pipe_(pipe) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { end(true); }

  /// Waits for the process, ended by force or not; its status, where the system still has it.
  int end(bool by_force) {
    if (process_ <= 0) return status_;
    if (by_force) ::kill(process_, SIGKILL);
    ::close(pipe_);
    while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) continue;
    process_ = 0;
    return status_;
  }

  Result<std::size_t> read(std::span<char> into, unsigned silence_s) const {
    for (;;) {
      struct pollfd waiting{pipe_, POLLIN, 0};
      const int ready = ::poll(&waiting, 1, static_cast<int>(silence_s) * 1000);
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0)
        return Error{Errc::corrupt, fmt::format("gives nothing within {} s: it is damaged, or its "
                                                "disk does not answer",
                                                silence_s)};
      const ssize_t count = ::read(pipe_, into.data(), into.size());
      if (count < 0 && errno == EINTR) continue;
      return count < 0 ? 0 : static_cast<std::size_t>(count);
    }
  }

 private:
  pid_t process_;
  int pipe_;
  int status_ = 0;
};

/// What became of a child that did not end its message.
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

Error broken_off() {
  return {Errc::corrupt, "is damaged: what was unpacked of it breaks off"};
}

/// Fills all of `into`.
Status fill(const ByteFeed& feed, std::span<char> into) {
  while (!into.empty()) {
    const auto count = feed(into);
    if (!count) return count.error();
    if (*count == 0 || *count > into.size()) return broken_off();
    into = into.subspan(*count);
  }
  return Done{};
}

Error told_error(std::span<const char> bytes) {
  constexpr std::array codes{Errc::corrupt, Errc::unsupported, Errc::too_few_samples,
                             Errc::unreadable, Errc::invalid_argument};
  const auto code = std::ranges::find_if(
      codes, [&](Errc known) { return !bytes.empty() && bytes[0] == static_cast<char>(known); });
  std::string message;
  for (const char c : bytes.empty() ? bytes : bytes.subspan(1))
    message += static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
  if (message.empty()) message = "cannot be unpacked";
  return {code == codes.end() ? Errc::corrupt : *code, std::move(message)};
}

}  // namespace

Status take_message(const ByteFeed& feed, const ByteTaker& take) {
  std::vector<char> bytes;
  for (;;) {
    std::array<char, sizeof(FrameHeader)> start;
    if (const Status begun = fill(feed, start); !begun) return begun;
    FrameHeader header;
    std::memcpy(&header, start.data(), sizeof header);
    if (header.bytes > most_frame_bytes) return broken_off();
    bytes.resize(header.bytes);
    if (const Status filled = fill(feed, bytes); !filled) return filled;
    if (header.kind == FrameKind::end) return Done{};
    if (header.kind == FrameKind::error) return told_error(bytes);
    if (header.kind != FrameKind::data) return broken_off();
    if (const Status taken = take(bytes); !taken) return taken;
  }
}

Status run_in_child(const std::function<Status(const ByteSink&)>& work,
                    const ByteTaker& take,
                    const ChildLimits& limits) {
  const auto failed = [](const char* what) {
    return Error{Errc::unreadable, fmt::format("cannot be unpacked: {}: {}", what,
                                               std::generic_category().message(errno))};
  };
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failed("no pipe");
  ::fcntl(ends[1], F_SETPIPE_SZ, static_cast<int>(most_frame_bytes));  // refused, it is but slower
  const pid_t self = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) {
    // The standard streams are put aside: the pipe may lie among them.
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
  Child child(process, ends[0]);
  bool broke_off = false;
  const ByteFeed feed = [&](std::span<char> into) {
    auto count = child.read(into, limits.silence_s);
    broke_off = broke_off || (count && *count == 0);
    return count;
  };
  const Status taken = take_message(feed, take);
  const int status = child.end(!taken && !broke_off);
  if (!taken && broke_off) return how_it_ended(status, limits);
  return taken;
}

}  // namespace proofmass::io
