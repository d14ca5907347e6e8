#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/serve/child_process.hpp"

namespace proofmass::serve {

enum class JobState { waiting, running, done, failed, cancelled };

/// How a run of the program goes.
struct JobStatus {
  JobState state = JobState::waiting;
  double fraction = 0.0;  ///< done, of the stage
  std::string stage{};
  std::vector<std::string> messages{};  ///< lines of its standard error: notes, the error
  ChildEnd end{};                       ///< how it ended
  double seconds = 0.0;                 ///< that it has run
};

/// Which jobs go first.
enum class JobUrgency { asked, background };

/// Runs programs, so many at a time, those asked for first. A program that crashes ends its job and
/// nothing else. All are killed when this goes.
class JobQueue {
 public:
  explicit JobQueue(std::size_t at_a_time);
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;
  ~JobQueue();

  [[nodiscard]] std::uint64_t add(ChildCommand command, JobUrgency urgency);
  /// None where the job is not known.
  [[nodiscard]] std::optional<JobStatus> status(std::uint64_t id) const;
  void cancel(std::uint64_t id);
  /// Moves a waiting job to those asked for.
  void hurry(std::uint64_t id);
  /// Cancels it and forgets it.
  void forget(std::uint64_t id);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "progress 42 reading": what a run says of itself on standard error where PROOFMASS_PROGRESS is
/// "lines". Whether it was one.
[[nodiscard]] bool take_progress(std::string_view line, JobStatus& status);

}  // namespace proofmass::serve
