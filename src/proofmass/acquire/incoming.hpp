#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// What the reading thread hands on, in its order.
struct Incoming {
  enum class Kind {
    rows,
    notes,     ///< without rows
    stalled,   ///< nothing has come for `silence_s`
    gone,      ///< the source failed: `reason`
    reopened,  ///< it is there again, with this head
    gave_up,   ///< it stays away: the last
    ended,     ///< as it should: the last
  };
  Kind kind = Kind::rows;
  Arrival arrival{};
  std::uint64_t overrun = 0;  ///< rows in front of it that found no room
  /// After a reopening: the device's count went on, and lost_before is by it.
  bool is_counted = false;
  double silence_s = 0.0;
  std::string reason{};
  std::shared_ptr<const SourceHead> head{};
  /// Of sources without a clock of their own, as the host's clock tells: time in front of the rows
  /// that none stands for, and how far apart the first ones are.
  double gap_s = 0.0;
  double step_s = 0.0;
};

}  // namespace proofmass::acquire
