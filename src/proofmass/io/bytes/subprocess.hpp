#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Resource limits of a child process.
struct ChildLimits {
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< beyond the memory mapped at its start
  unsigned cpu_s = 20;
  unsigned silence_s = 60;  ///< without output
};

/// Passes bytes to the receiver; false if there is none any more.
using ByteSink = std::function<bool(std::span<const char>)>;
using ByteTaker = std::function<Status(std::span<const char>)>;

/// Fills the beginning of `into`; 0 only at the end.
using BytePump = std::function<Result<std::size_t>(std::span<char>)>;

/// A message from a child is a sequence of frames: a kind, a length of at most most_frame_bytes,
/// that many bytes; the last frame is the end or an error.
inline constexpr std::size_t most_frame_bytes = std::size_t{1} << 20;

/// Parses a message from arbitrary bytes.
class MessageReader {
 public:
  explicit MessageReader(BytePump feed) : feed_(std::move(feed)) {}

  /// The next bytes of the message, never more than most_frame_bytes, valid until the next call;
  /// none only at its end.
  /// Errors: the one in the message; the feed's; corrupt (not a message, or truncated).
  [[nodiscard]] Result<std::span<const char>> next();

 private:
  BytePump feed_;
  std::vector<char> bytes_;
  bool is_at_end_ = false;
};

/// Reads a whole message and passes on its contents. Errors: MessageReader's; `take`'s.
[[nodiscard]] Status take_message(const BytePump& feed, const ByteTaker& take);

/// Task of a child process, with the sink that leads back to the parent.
using ChildWork = std::function<Status(const ByteSink&)>;

/// A child process for libraries that damaged files can crash. What `work` passes to its sink there
/// is received here, in order but in pieces of any length, on demand; until then the child waits.
/// The child has no standard streams, default signals and the given limits. It ends with this
/// object, or with the thread that started it.
class Subprocess {
 public:
  /// Errors: unreadable, if no process can be started.
  [[nodiscard]] static Result<Subprocess> start(const ChildWork& work, const ChildLimits& limits);

  Subprocess(Subprocess&&) noexcept;
  Subprocess& operator=(Subprocess&&) noexcept;
  Subprocess(const Subprocess&) = delete;
  Subprocess& operator=(const Subprocess&) = delete;
  ~Subprocess();

  /// The next bytes, valid until the next call; none only at the end, and none after an error.
  /// Errors: those of `work`; corrupt, if the child crashed or reached a limit.
  [[nodiscard]] Result<std::span<const char>> next();

 private:
  class Process;
  explicit Subprocess(std::unique_ptr<Process> process);

  std::unique_ptr<Process> process_;
};

/// Runs `work` in a Subprocess to its end; when this returns the child has ended, in any case.
/// Errors: those of `work` and `take`, and the child's.
[[nodiscard]] Status run_in_child(const ChildWork& work,
                                  const ByteTaker& take,
                                  const ChildLimits& limits);

}  // namespace proofmass::io
