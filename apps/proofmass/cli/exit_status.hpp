#pragma once

#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "proofmass/core/result.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {

/// Exit status of the command, on which documentation and scripts rely. An interrupt ends the
/// process with 130 (cli/console.hpp).
enum ExitStatus : int {
  done = 0,
  failed = 1,
  usage = 2,
  bad_input = 3,
  bad_device = 4,
  bad_data = 5,  ///< completed, but the data are bad: only with --strict
};

/// Ends a verb early: main() prints the message and returns the status.
class Failure : public std::exception {
 public:
  Failure(ExitStatus status, std::string message) : status_(status), message_(std::move(message)) {}
  /// The message names the options that would help.
  Failure(ExitStatus status, const Error& error)
      : status_(status), message_(report::with_flags(error)), code_(error.code) {}
  [[nodiscard]] ExitStatus status() const { return status_; }
  /// Code of the library error that caused it, if any.
  [[nodiscard]] std::optional<Errc> code() const { return code_; }
  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }

 private:
  ExitStatus status_;
  std::string message_;
  std::optional<Errc> code_;
};

/// Stage at which an error occurred, which determines the exit status.
enum class Stage { reading, computing, writing };

[[nodiscard]] ExitStatus status_of(const Error& error, Stage stage);

/// The value, or a Failure.
template <class T>
[[nodiscard]] T need(Result<T> result, Stage stage) {
  if (!result) throw Failure(status_of(result.error(), stage), result.error());
  return std::move(result).value();
}

}  // namespace proofmass::app
