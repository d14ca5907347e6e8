#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/fleet/pool.hpp"

// Jobs that another process has done elsewhere: on the workers of a cluster.
namespace proofmass::fleet {

struct DriverOptions {
  std::vector<std::string> command;  ///< the driver's program and its arguments
  std::string program;               ///< Proofmass on the workers; empty: theirs
  double timeout_s = 0.0;            ///< a job that runs longer is ended; 0: none is
  std::size_t memory_bytes = 0;      ///< limit of a job; 0: none
};

/// What the driver's jobs are, and who takes their results.
struct DriverWork {
  /// The verb with its files and flags.
  std::function<std::vector<std::string>(std::size_t job)> arguments;
  /// The file that takes a job's standard output.
  std::function<std::string(std::size_t job)> output;
  /// Whether the job is to be done again.
  std::function<bool(const Ended&)> ended;
  /// Often; false ends the driver.
  std::function<bool(std::size_t running)> goes_on;
};

/// Runs jobs by a driver, which is given one JSON object a line on its standard input,
///
///     {"job": 3, "arguments": […], "folder": "…", "program": "…", "timeout_s": 0, "memory_bytes":
///     0}
///
/// and writes one on its standard output for each job that has ended,
///
///     {"job": 3, "status": 0, "signal": 0, "timed_out": false, "seconds": 1.5, "words": "…",
///      "document": "…"}
///
/// It ends at the end of its input. Errors: unreadable (it cannot be started, or ends before its
/// jobs; the message has the end of what it wrote to standard error), corrupt (a line that is none
/// of these), unwritable (a document).
[[nodiscard]] Status run_driver(std::span<const std::size_t> jobs,
                                const DriverOptions& options,
                                const DriverWork& work);

}  // namespace proofmass::fleet
