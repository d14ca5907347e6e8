#pragma once

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
};

/// How a program ended.
struct ChildEnd {
  int status = 0;  ///< exit status, where signal is 0
  int signal = 0;
};

/// A program that runs in a process group of its own, without standard input; its standard output
/// goes to a file of the folder or nowhere, its standard error is read line by line. Killed with
/// its group when this goes.
class ChildProcess {
 public:
  /// Errors: unreadable (no such program, no process can be started).
  [[nodiscard]] static Result<ChildProcess> start(const ChildCommand& command);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  [[nodiscard]] int pid() const { return pid_; }
  /// Hands each line of standard error to `take` until the program has ended. Asks `cancelled` ten
  /// times a second; once it says so the program is asked to end, and killed after two seconds.
  [[nodiscard]] ChildEnd follow(const std::function<void(std::string_view line)>& take,
                                const std::function<bool()>& cancelled);

 private:
  ChildProcess(int pid, int errors) : pid_(pid), errors_(errors) {}
  int pid_ = -1;
  int errors_ = -1;  ///< the end of the pipe that its standard error goes to
};

}  // namespace proofmass::serve
