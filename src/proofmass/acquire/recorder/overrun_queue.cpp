#include "proofmass/acquire/recorder/overrun_queue.hpp"

#include <fmt/format.h>
#include <utility>

namespace proofmass::acquire {

Arrival OverrunQueue::spare() {
  Arrival arrival;
  {
    const std::scoped_lock hold(lock_);
    if (!spares_.empty()) {
      arrival = std::move(spares_.back());
      spares_.pop_back();
    }
  }
  arrival.clear(channel_count_);
  return arrival;
}

void OverrunQueue::put(Arrival&& arrival) {
  const std::scoped_lock hold(lock_);
  if (rows_ + arrival.rows() > most_rows_) {
    dropped_ += arrival.rows() + arrival.lost_before;
    spares_.push_back(std::move(arrival));
    return;
  }
  arrival.lost_before += std::exchange(dropped_, 0);
  rows_ += arrival.rows();
  waiting_.push_back(std::move(arrival));
  changed_.notify_one();
}

void OverrunQueue::end(std::optional<Error> why) {
  const std::scoped_lock hold(lock_);
  ended_ = true;
  why_ = std::move(why);
  changed_.notify_one();
}

Result<Arrived> OverrunQueue::take(Arrival& arrival, std::chrono::milliseconds patience) {
  arrival.clear(channel_count_);
  std::unique_lock hold(lock_);
  changed_.wait_for(hold, patience, [&] { return ended_ || !waiting_.empty(); });
  if (!waiting_.empty()) {
    std::swap(arrival, waiting_.front());
    rows_ -= arrival.rows();
    spares_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
    return arrival.rows() > 0 ? Arrived::rows : Arrived::nothing;
  }
  if (ended_ && dropped_ > 0) {
    arrival.notes.push_back(
        {Severity::warning, fmt::format("the last {} rows were lost: they were not read in time",
                                        std::exchange(dropped_, 0))});
    return Arrived::nothing;
  }
  if (!ended_) return Arrived::nothing;
  if (why_) return *why_;
  return Arrived::ended;
}

}  // namespace proofmass::acquire
