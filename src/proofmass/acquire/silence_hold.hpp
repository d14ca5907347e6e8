#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "proofmass/acquire/incoming.hpp"

namespace proofmass::acquire {

/// Of rows without a device's clock it cannot be said at once what a silence before them was: a
/// delay, after which all of them come in a burst, or a gap. The rows after a silence are held for
/// a third of a second, which tells. The first rows of a source without any clock wait for the
/// next, which tell how far apart they are. All else passes.
class SilenceHold {
 public:
  /// rate_hz: 0 if none is known. A source that is not paced has no silence.
  SilenceHold(bool has_device_clock, bool is_paced, double rate_hz, double stall_s);

  void put(Incoming item);
  /// The next that is settled; with `at_end` the next at all.
  [[nodiscard]] bool take(Incoming& item, bool at_end);

 private:
  [[nodiscard]] bool is_settled() const;
  void settle();

  bool counts_;
  bool waits_for_second_;
  double rate_hz_;
  double stall_s_;
  std::deque<Incoming> held_;
  std::size_t settled_ = 0;               ///< of those, from the front
  std::optional<std::int64_t> quiet_ns_;  ///< host's time of the last rows before a silence
  std::optional<std::int64_t> last_ns_;   ///< of the last rows put in
};

}  // namespace proofmass::acquire
