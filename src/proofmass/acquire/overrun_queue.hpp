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

/// What goes from a thread that blocks inside a library to the one that reads the source: bounded,
/// and what found no room is counted.
class OverrunQueue {
 public:
  OverrunQueue(std::size_t channel_count, std::size_t most_rows)
      : channel_count_(channel_count), most_rows_(most_rows) {}

  /// An empty one, with the memory of one that was read.
  [[nodiscard]] Arrival spare();
  /// Where there is no room the rows are lost: they are counted in lost_before of the next that
  /// find some.
  void put(Arrival&& arrival);
  /// No more will come; `why` if that is a failure.
  void end(std::optional<Error> why = {});

  /// As Source::read(). What was put before the end is still read.
  [[nodiscard]] Result<Arrived> take(Arrival& arrival, std::chrono::milliseconds patience);

 private:
  const std::size_t channel_count_, most_rows_;
  std::mutex lock_;
  std::condition_variable changed_;
  std::deque<Arrival> waiting_;
  std::vector<Arrival> spares_;
  std::size_t rows_ = 0;       // in waiting_
  std::uint64_t dropped_ = 0;  // since the last that found room
  bool ended_ = false;
  std::optional<Error> why_;
};

}  // namespace proofmass::acquire
