#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Bounded queue from a thread that blocks inside a library to the one that reads the source; rows
/// that found no room are counted.
class OverrunQueue {
 public:
  OverrunQueue(std::size_t channel_count, std::size_t most_rows)
      : channel_count_(channel_count), most_rows_(most_rows) {}

  /// An empty arrival, with the memory of one that was read.
  [[nodiscard]] Arrival spare();
  /// If there is no room the rows are lost: they are added to lost_before of the next arrival that
  /// has room.
  void put(Arrival&& arrival);
  /// Ends the queue; `why` if that is due to a failure.
  void end(std::optional<Error> why = {});

  /// As Source::read(). Items added before the end are still returned.
  [[nodiscard]] Result<Arrived> take(Arrival& arrival, std::chrono::milliseconds patience);

 private:
  const std::size_t channel_count_, most_rows_;
  std::mutex lock_;
  std::condition_variable changed_;
  std::deque<Arrival> waiting_;
  std::vector<Arrival> spares_;
  std::size_t rows_ = 0;       // in waiting_
  std::uint64_t dropped_ = 0;  // since the last arrival that had room
  bool ended_ = false;
  std::optional<Error> why_;
};

}  // namespace proofmass::acquire
