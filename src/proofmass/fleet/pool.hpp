#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "proofmass/core/result.hpp"

// Processes of our own, a job each.
namespace proofmass::fleet {

struct PoolOptions {
  std::size_t processes = 1;     ///< at once
  double timeout_s = 0.0;        ///< a job that runs longer is ended; 0: none is
  std::size_t memory_bytes = 0;  ///< limit of a job beyond what is mapped at its start; 0: none
};

/// How a job's process ended.
struct Ended {
  std::size_t job = 0;
  int status = 0;          ///< its exit status, where signal is 0
  int signal = 0;          ///< which ended it
  bool timed_out = false;  ///< it was ended for running longer than the timeout
  std::string words;       ///< the end of what it wrote to standard error
  double seconds = 0.0;
};

/// What a pool asks of whoever runs it.
struct PoolWork {
  /// In a child process, which ends with what this returns. Standard input is nowhere, standard
  /// error comes back as Ended::words.
  std::function<int(std::size_t job)> run;
  /// The file that takes a job's standard output.
  std::function<std::string(std::size_t job)> output;
  /// In the parent; whether the job is to be done again, after all others.
  std::function<bool(const Ended&)> ended;
  /// In the parent, often; false ends all that runs and starts nothing more.
  std::function<bool(std::size_t running)> goes_on;
};

/// Runs jobs in their order, each in a process forked from this one, which may have no other
/// threads that hold locks. A child is the leader of a process group of its own, which is gone when
/// the child has ended, and when the pool's process has. Nothing of a child's crash reaches the
/// others. Errors: unreadable (the system gives no process).
[[nodiscard]] Status run_pool(std::span<const std::size_t> jobs,
                              const PoolOptions& options,
                              const PoolWork& work);

}  // namespace proofmass::fleet
