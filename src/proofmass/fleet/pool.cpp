#include "proofmass/fleet/pool.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <fcntl.h>
#include <fmt/format.h>
#include <list>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace proofmass::fleet {
namespace {

using Clock = std::chrono::steady_clock;

// ---- the child's side ----

void point_streams(const std::string& output, int errors) {
  constexpr int readable_by_all = 0666;
  const int nowhere = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int file =
      ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, readable_by_all);
  const bool pointed = nowhere >= 0 && ::dup2(nowhere, STDIN_FILENO) >= 0 &&
                       ::dup2(errors, STDERR_FILENO) >= 0 && file >= 0 &&
                       ::dup2(file, STDOUT_FILENO) >= 0;
  if (pointed) return;
  std::fputs("its document cannot be written", stderr);  // NOLINT: these are the child's words
  ::_exit(1);
}

// Limits private writable memory; reserved addresses cost nothing, except those that the address
// sanitizer reserves.
void limit_memory(std::size_t bytes) {
#ifdef __SANITIZE_ADDRESS__
  bytes = 0;
#endif
  if (bytes == 0) return;
  struct rlimit now{};
  if (::getrlimit(RLIMIT_DATA, &now) != 0) return;
  const auto wanted = std::min<rlim_t>(bytes, now.rlim_max);
  const struct rlimit limit{wanted, wanted};
  ::setrlimit(RLIMIT_DATA, &limit);
}

[[noreturn]] void be_job(
    std::size_t job, int errors, pid_t parent, const PoolOptions& options, const PoolWork& work) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  point_streams(work.output(job), errors);
  limit_memory(options.memory_bytes);
  constexpr struct rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  int status = 1;
  try {
    status = work.run(job);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);  // NOLINT: the child's, which comes back as words
  }
  std::fflush(stderr);
  ::_exit(status);
}

// ---- the parent's side ----

struct Child {
  std::size_t job = 0;
  pid_t process = 0;
  int handle = -1;  // pollable: readable once the process has ended
  int errors = -1;  // what it writes to standard error
  Clock::time_point begun;
  bool timed_out = false;
  std::string words;
};

double seconds_since(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

void read_words(Child& child) {
  constexpr std::size_t most = 4096;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = ::read(child.errors, buffer.data(), buffer.size());
    if (count <= 0) break;
    child.words.append(buffer.data(), static_cast<std::size_t>(count));
    if (child.words.size() > 2 * most) child.words.erase(0, child.words.size() - most);
  }
}

void end_group(const Child& child) {
  if (::kill(-child.process, SIGKILL) != 0) ::kill(child.process, SIGKILL);
}

Error no_process() {
  return {Errc::unreadable, fmt::format("no process can be started: {}", std::strerror(errno))};
}

Result<Child> start(std::size_t job, const PoolOptions& options, const PoolWork& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return no_process();
  std::fflush(nullptr);  // what is buffered here would be written by the child, too
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process == 0) be_job(job, ends[1], parent, options, work);
  ::close(ends[1]);
  if (process > 0) ::setpgid(process, process);  // by both, so that it holds for whoever is first
  // By its number: the declaration of glibc 2.36 cannot be linked from C++.
  const int handle = process > 0 ? static_cast<int>(::syscall(SYS_pidfd_open, process, 0)) : -1;
  if (handle < 0) {
    const Error error = no_process();
    ::close(ends[0]);
    if (process > 0) {
      ::kill(process, SIGKILL);
      ::waitpid(process, nullptr, 0);
    }
    return error;
  }
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return Child{job, process, handle, ends[0], Clock::now(), false, {}};
}

Ended finish(Child& child) {
  int status = 0;
  end_group(child);  // what it started itself; while it is not waited for, the number is its own
  while (::waitpid(child.process, &status, 0) < 0 && errno == EINTR) continue;
  read_words(child);
  ::close(child.handle);
  ::close(child.errors);
  Ended ended;
  ended.job = child.job;
  ended.timed_out = child.timed_out;
  ended.seconds = seconds_since(child.begun);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  if (WIFEXITED(status)) ended.status = WEXITSTATUS(status);
  ended.words = std::move(child.words);
  return ended;
}

// Until one of them has ended, written, or a moment has gone.
void wait_for(const std::list<Child>& children) {
  constexpr int moment_ms = 50;
  std::vector<pollfd> awaited;
  for (const Child& child : children) {
    awaited.push_back({child.handle, POLLIN, 0});
    awaited.push_back({child.errors, POLLIN, 0});
  }
  ::poll(awaited.data(), awaited.size(), moment_ms);
}

bool has_ended(const Child& child) {
  pollfd handle{child.handle, POLLIN, 0};
  return ::poll(&handle, 1, 0) > 0;
}

/// Starts waiting jobs while fewer processes than allowed run.
Status start_waiting(std::deque<std::size_t>& waiting,
                     std::list<Child>& children,
                     const PoolOptions& options,
                     const PoolWork& work) {
  while (children.size() < options.processes && !waiting.empty()) {
    auto started = start(waiting.front(), options, work);
    if (!started) return started.error();
    waiting.pop_front();
    children.push_back(std::move(started).value());
  }
  return Done{};
}

void end_if_late(Child& child, double timeout_s) {
  const bool late = timeout_s > 0.0 && seconds_since(child.begun) > timeout_s;
  if (!late || child.timed_out || has_ended(child)) return;
  child.timed_out = true;
  end_group(child);
}

/// Removes the children that have ended; the jobs to repeat wait again.
void collect(std::list<Child>& children,
             std::deque<std::size_t>& waiting,
             const PoolOptions& options,
             const PoolWork& work) {
  for (auto child = children.begin(); child != children.end();) {
    read_words(*child);
    end_if_late(*child, options.timeout_s);
    if (!has_ended(*child)) {
      ++child;
      continue;
    }
    const Ended ended = finish(*child);
    child = children.erase(child);
    if (work.ended(ended)) waiting.push_back(ended.job);
  }
}

}  // namespace

Status run_pool(std::span<const std::size_t> jobs,
                const PoolOptions& options,
                const PoolWork& work) {
  std::deque<std::size_t> waiting(jobs.begin(), jobs.end());
  std::list<Child> children;
  Status outcome = Done{};
  while (!waiting.empty() || !children.empty()) {
    if (!outcome || !work.goes_on(children.size())) {
      for (Child& child : children) finish(child);
      return outcome;
    }
    outcome = start_waiting(waiting, children, options, work);
    wait_for(children);
    collect(children, waiting, options, work);
  }
  return outcome;
}

}  // namespace proofmass::fleet
