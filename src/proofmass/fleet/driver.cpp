#include "proofmass/fleet/driver.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "proofmass/core/new_file.hpp"

namespace proofmass::fleet {
namespace {

using DriverJson = nlohmann::ordered_json;

std::string job_line(std::size_t job, const DriverOptions& options, const DriverWork& work) {
  std::error_code problem;
  return DriverJson{{"job", job},
                    {"arguments", work.arguments(job)},
                    {"folder", std::filesystem::current_path(problem).string()},
                    {"program", options.program},
                    {"timeout_s", options.timeout_s},
                    {"memory_bytes", options.memory_bytes}}
             .dump(-1, ' ', false, DriverJson::error_handler_t::replace) +
         '\n';
}

/// The driver's process and the ends of its pipes. What is still running when this goes is ended.
class Driver {
 public:
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  ~Driver() {
    close_end(input_);
    if (process_ > 0) {
      ::kill(process_, SIGTERM);
      while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
    }
    close_end(output_);
    close_end(errors_);
  }

  Status start(const std::vector<std::string>& command) {
    std::array<std::array<int, 2>, 3> pipes{};
    for (auto& pipe : pipes)
      if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return failure(command);
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, pipes[0][0], STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, pipes[1][1], STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, pipes[2][1], STDERR_FILENO);
    const int outcome =
        ::posix_spawnp(&process_, words[0], &actions, nullptr, words.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    for (const int end : {pipes[0][0], pipes[1][1], pipes[2][1]}) ::close(end);
    input_ = pipes[0][1];
    output_ = pipes[1][0];
    errors_ = pipes[2][0];
    for (const int end : {input_, output_, errors_}) ::fcntl(end, F_SETFL, O_NONBLOCK);
    if (outcome == 0) return Done{};
    process_ = -1;
    errno = outcome;
    return failure(command);
  }

  void send(std::string_view lines) { pending_ += lines; }

  /// Moves what can be moved, waiting a moment for it. False once it writes no more.
  [[nodiscard]] bool exchange() {
    constexpr int moment_ms = 100;
    std::array<pollfd, 3> ends{
        {{output_, POLLIN, 0}, {errors_, POLLIN, 0}, {pending_.empty() ? -1 : input_, POLLOUT, 0}}};
    ::poll(ends.data(), ends.size(), moment_ms);
    if (!pending_.empty() && ends[2].revents != 0) {
      const ssize_t count = ::write(input_, pending_.data(), pending_.size());
      if (count > 0) pending_.erase(0, static_cast<std::size_t>(count));
      if (count < 0 && errno == EPIPE) pending_.clear();
    }
    read_into(errors_, words_);
    constexpr std::size_t most_words = 4096;
    if (words_.size() > most_words) words_.erase(0, words_.size() - most_words);
    return read_into(output_, received_);
  }

  /// The next complete line; empty if there is none.
  [[nodiscard]] std::string line() {
    const std::size_t end = received_.find('\n');
    if (end == std::string::npos) return {};
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    return line;
  }

  [[nodiscard]] Error ended_early() const {
    std::string words = words_;
    while (words.ends_with('\n')) words.pop_back();
    const std::size_t last = words.rfind('\n');
    if (last != std::string::npos) words.erase(0, last + 1);
    return {Errc::unreadable,
            "the driver ended before its jobs" + (words.empty() ? "" : ": " + words)};
  }

 private:
  static void close_end(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
  static Error failure(const std::vector<std::string>& command) {
    return {Errc::unreadable,
            fmt::format("{}: cannot be started: {}", command.front(), std::strerror(errno))};
  }
  // False at its end.
  static bool read_into(int end, std::string& text) {
    std::array<char, 65536> buffer{};
    for (;;) {
      const ssize_t count = ::read(end, buffer.data(), buffer.size());
      if (count == 0) return false;
      if (count < 0) return errno == EAGAIN || errno == EINTR;
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

  pid_t process_ = -1;
  int input_ = -1, output_ = -1, errors_ = -1;
  std::string pending_, received_, words_;
};

Result<Ended> ended_of(const std::string& line, std::string& document) {
  try {
    const DriverJson json = DriverJson::parse(line);
    Ended ended;
    json.at("job").get_to(ended.job);
    json.at("status").get_to(ended.status);
    json.at("signal").get_to(ended.signal);
    json.at("timed_out").get_to(ended.timed_out);
    json.at("seconds").get_to(ended.seconds);
    json.at("words").get_to(ended.words);
    json.at("document").get_to(document);
    return ended;
  } catch (const nlohmann::json::exception&) {
    return Error{Errc::corrupt, "the driver wrote a line that is not a result: " + line};
  }
}

}  // namespace

Status run_driver(std::span<const std::size_t> jobs,
                  const DriverOptions& options,
                  const DriverWork& work) {
  if (jobs.empty()) return Done{};
  Driver driver;
  if (const Status started = driver.start(options.command); !started) return started;
  for (const std::size_t job : jobs) driver.send(job_line(job, options, work));
  std::size_t running = jobs.size();
  bool writes = true;
  while (running > 0) {
    if (!work.goes_on(running)) return Done{};
    if (!writes) return driver.ended_early();
    writes = driver.exchange();
    for (std::string line = driver.line(); !line.empty(); line = driver.line()) {
      std::string document;
      const auto ended = ended_of(line, document);
      if (!ended) return ended.error();
      if (const Status written = write_file(work.output(ended->job), document); !written)
        return written;
      if (work.ended(*ended))
        driver.send(job_line(ended->job, options, work));
      else
        --running;
    }
  }
  return Done{};
}

}  // namespace proofmass::fleet
