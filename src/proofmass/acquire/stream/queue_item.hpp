#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Item passed on by the reading thread, in order.
struct QueueItem {
  enum class Kind {
    rows,
    notes,     ///< without rows
    stalled,   ///< no data for `silence_s`
    gone,      ///< the source failed: `reason`
    reopened,  ///< it is available again, with this head
    gave_up,   ///< it stays unavailable: the last item
    ended,     ///< regular end: the last item
  };
  Kind kind = Kind::rows;
  Arrival arrival{};
  std::uint64_t overrun = 0;  ///< rows before it that found no room
  /// After a reopening: the device's count continued, and lost_before is based on it.
  bool is_counted = false;
  double silence_s = 0.0;
  std::string reason{};
  std::shared_ptr<const SourceHead> head{};
  /// For sources without their own clock, from the host's clock: time before the rows that is not
  /// accounted for, and the interval between the first ones.
  double gap_s = 0.0;
  double step_s = 0.0;
};

}  // namespace proofmass::acquire
