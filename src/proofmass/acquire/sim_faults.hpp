#pragma once

#include <cstdint>
#include <optional>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// What goes wrong with a simulated device, so that whoever records it can be tried. Times are the
/// device's, from its first row.
struct SimFaults {
  double drop = 0.0;  ///< share of the blocks that are lost; a counter tells
  /// Nothing comes from then on for so long; then what was measured meanwhile comes at once.
  struct Stall {
    double at_s, for_s;
  };
  std::optional<Stall> stall{};
  std::optional<double> unplug_s{};  ///< gone from then on
  struct ClockJump {
    double at_s, by_s;
  };
  std::optional<ClockJump> clock_jump{};
  bool dead_clock = false;  ///< the device's clock stands still
};

/// Of "drop=0.01", "stall=5,2", "unplug=8", "clock-jump=5,-1", "dead-clock=1".
/// Errors: invalid_argument.
[[nodiscard]] Result<SimFaults> sim_faults(SourceUri& uri);

}  // namespace proofmass::acquire
