#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <vector>

#include "proofmass/acquire/incoming.hpp"

namespace proofmass::acquire {

/// Between the thread that reads a source and the one that works on what it reads: so many bytes at
/// most, in arrivals that go round.
class ArrivalQueue {
 public:
  explicit ArrivalQueue(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Takes an item and leaves an old one in its place, to be filled again. False: there is no room,
  /// and none came within the patience; the item is untouched. What is neither rows nor notes
  /// always has room.
  [[nodiscard]] bool put(Incoming& item, std::chrono::milliseconds patience);
  /// The next item in place of an old one, which is kept to be filled again.
  [[nodiscard]] bool take(Incoming& item, std::chrono::milliseconds patience);
  /// Whoever waits to take something waits no longer.
  void wake();

 private:
  [[nodiscard]] bool has_room(std::size_t bytes) const {
    return items_.empty() || bytes_ + bytes <= most_bytes_;
  }

  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Incoming> items_;
  std::size_t bytes_ = 0;
  bool is_woken_ = false;
  std::vector<Arrival> spare_;
};

}  // namespace proofmass::acquire
