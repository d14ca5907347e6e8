#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <vector>

#include "proofmass/acquire/stream/queue_item.hpp"

namespace proofmass::acquire {

/// Queue between the thread that reads a source and the one that processes its data; limited in
/// bytes, with arrivals that are reused.
class ArrivalQueue {
 public:
  explicit ArrivalQueue(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Adds an item and returns an old one in its place, to be reused. False: no room within the
  /// patience; the item is unchanged. Items other than rows and notes always have room.
  [[nodiscard]] bool put(QueueItem& item, std::chrono::milliseconds patience);
  /// Swaps in the next item; the old one is kept for reuse.
  [[nodiscard]] bool take(QueueItem& item, std::chrono::milliseconds patience);
  /// Wakes a waiting take().
  void wake();

 private:
  [[nodiscard]] bool has_room(std::size_t bytes) const {
    return items_.empty() || bytes_ + bytes <= most_bytes_;
  }

  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<QueueItem> items_;
  std::size_t bytes_ = 0;
  bool is_woken_ = false;
  std::vector<Arrival> spare_;
};

}  // namespace proofmass::acquire
