#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// What a child process may use before it is ended.
struct ChildLimits {
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< beyond what is mapped when it begins
  unsigned cpu_s = 20;
  unsigned silence_s = 60;  ///< without a word
};

/// Hands bytes to whoever waits for them; false where nobody does any more.
using ByteSink = std::function<bool(std::span<const char>)>;
using ByteTaker = std::function<Status(std::span<const char>)>;

/// Fills `into` from its front; 0 only at the end.
using ByteFeed = std::function<Result<std::size_t>(std::span<char>)>;

/// A message from a child is a run of frames: a kind, a length of at most most_frame_bytes, that
/// many bytes; the last says that it is the end, or what went wrong.
inline constexpr std::size_t most_frame_bytes = std::size_t{1} << 20;

/// Takes a message apart, whatever bytes it is made of.
class MessageReader {
 public:
  explicit MessageReader(ByteFeed feed) : feed_(std::move(feed)) {}

  /// The next bytes that the message holds, never more than most_frame_bytes, good until the next
  /// are asked for; none only at its end.
  /// Errors: the one that the message tells; the feed's; corrupt (no message, or one that breaks
  /// off).
  [[nodiscard]] Result<std::span<const char>> next();

 private:
  ByteFeed feed_;
  std::vector<char> bytes_;
  bool is_at_end_ = false;
};

/// Takes all of a message and hands on what it holds. Errors: MessageReader's; `take`'s.
[[nodiscard]] Status take_message(const ByteFeed& feed, const ByteTaker& take);

/// What a process is to do, with the sink that leads back to who started it.
using ChildWork = std::function<Status(const ByteSink&)>;

/// A process of its own for libraries that files may bring down: what `work` hands to its sink
/// there arrives here, in order but in pieces of any length, when it is asked for; until then it
/// waits. The child has no standard streams, default signals and the limits. It is gone when this
/// is, or the thread that started it.
class WatchedChild {
 public:
  /// Errors: unreadable, if no process can be started.
  [[nodiscard]] static Result<WatchedChild> start(const ChildWork& work, const ChildLimits& limits);

  WatchedChild(WatchedChild&&) noexcept;
  WatchedChild& operator=(WatchedChild&&) noexcept;
  WatchedChild(const WatchedChild&) = delete;
  WatchedChild& operator=(const WatchedChild&) = delete;
  ~WatchedChild();

  /// The next bytes, good until the next are asked for; none only at the end, and nothing more
  /// after an error. Errors: those of `work`; corrupt, if the child crashed or came to a limit.
  [[nodiscard]] Result<std::span<const char>> next();

 private:
  class Process;
  explicit WatchedChild(std::unique_ptr<Process> process);

  std::unique_ptr<Process> process_;
};

/// Runs `work` in a WatchedChild to its end; when this returns the child is gone, however it ended.
/// Errors: those of `work` and `take`, and the child's.
[[nodiscard]] Status run_in_child(const ChildWork& work,
                                  const ByteTaker& take,
                                  const ChildLimits& limits);

}  // namespace proofmass::io
