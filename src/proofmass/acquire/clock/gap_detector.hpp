#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "proofmass/acquire/stream/queue_item.hpp"

namespace proofmass::acquire {

/// Without a device clock, a pause before rows may be a delay, after which they all arrive in a
/// burst, or a gap. Rows after a pause are held for a third of a second to decide. The first rows
/// of a source without any clock wait for the next, which determine their interval. Everything else
/// passes.
class GapDetector {
 public:
  /// rate_hz: 0 if unknown. A source that is not paced has no pauses.
  GapDetector(bool has_device_clock, bool is_paced, double rate_hz, double stall_s);

  void put(QueueItem item);
  /// The next decided item; with `at_end` the next in any case.
  [[nodiscard]] bool take(QueueItem& item, bool at_end);

 private:
  [[nodiscard]] bool is_settled() const;
  void settle();

  bool counts_;
  bool waits_for_second_;
  double rate_hz_;
  double stall_s_;
  std::deque<QueueItem> held_;
  std::size_t settled_ = 0;               ///< decided items, from the front
  std::optional<std::int64_t> quiet_ns_;  ///< host's time of the last rows before a pause
  std::optional<std::int64_t> last_ns_;   ///< host's time of the last rows added
};

}  // namespace proofmass::acquire
