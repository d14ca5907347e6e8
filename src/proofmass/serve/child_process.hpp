#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::serve {

/// How a program is run.
struct ChildCommand {
  std::vector<std::string> arguments;    ///< the program's path first
  std::string folder;                    ///< it works in
  std::vector<std::string> environment;  ///< "NAME=VALUE", in place of this process's own
  int input = -1, output = -1;           ///< descriptors of its standard input and output; -1: none
  std::chrono::milliseconds patience{2000};  ///< for its end, once it is asked to end
};

/// How a program ended.
struct ChildEnd {
  int status = 0;  ///< exit status, where signal is 0
  int signal = 0;
};

/// A program that runs in a process group of its own; its standard error is read line by line.
/// Killed with its group when this goes.
class ChildProcess {
 public:
  /// Errors: unreadable (no such program, no process can be started).
  [[nodiscard]] static Result<ChildProcess> start(const ChildCommand& command);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  [[nodiscard]] int pid() const { return pid_; }
  /// Hands each line of standard error to `take` until the program has ended. Asks `cancelled` ten
  /// times a second; once it says so the program is asked to end, and killed after its patience.
  [[nodiscard]] ChildEnd follow(const std::function<void(std::string_view line)>& take,
                                const std::function<bool()>& cancelled);

 private:
  ChildProcess(int pid, int errors, std::chrono::milliseconds patience)
      : pid_(pid), errors_(errors), patience_(patience) {}
  int pid_ = -1;
  int errors_ = -1;  ///< the end of the pipe that its standard error goes to
  std::chrono::milliseconds patience_;
};

}  // namespace proofmass::serve
