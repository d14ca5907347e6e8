#pragma once

#include <cstddef>
#include <functional>
#include <span>

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

/// Takes a message apart, whatever bytes it is made of, and hands on what it holds.
/// Errors: the one that the message tells; `take`'s; corrupt (no message, or one that breaks off).
[[nodiscard]] Status take_message(const ByteFeed& feed, const ByteTaker& take);

/// Runs `work` in a process of its own, for libraries that files may bring down: what it hands to
/// its sink arrives at `take`, here, in order but in pieces of any length. The child has no
/// standard streams, default signals and the limits; when this returns it is gone, however it
/// ended. Errors: those of `work` and `take`; corrupt, if the child crashed or came to a limit;
/// unreadable, if no process can be started.
[[nodiscard]] Status run_in_child(const std::function<Status(const ByteSink&)>& work,
                                  const ByteTaker& take,
                                  const ChildLimits& limits);

}  // namespace proofmass::io
