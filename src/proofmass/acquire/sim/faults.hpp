#pragma once

#include <cstdint>
#include <optional>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Faults of a simulated device, to test the recorder. Times are the device's, from its first row.
struct SimFaults {
  double drop = 0.0;  ///< fraction of the blocks that are lost; a counter reports it
  /// No data arrive for this time; then the data measured meanwhile arrive at once.
  struct Stall {
    double at_s, for_s;
  };
  std::optional<Stall> stall{};
  std::optional<double> unplug_s{};  ///< lost from then on
  struct ClockJump {
    double at_s, by_s;
  };
  std::optional<ClockJump> clock_jump{};
  bool dead_clock = false;  ///< the device's clock does not advance
};

/// Parses "drop=0.01", "stall=5,2", "unplug=8", "clock-jump=5,-1", "dead-clock=1".
/// Errors: invalid_argument.
[[nodiscard]] Result<SimFaults> sim_faults(SourceUri& uri);

}  // namespace proofmass::acquire
