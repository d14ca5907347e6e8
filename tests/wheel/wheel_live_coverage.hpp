#pragma once

#include "wheel_coverage.hpp"

// Coverage of the intervals of live_wheel(), at random times.
namespace proofmass::wheel_world {

struct LiveCoverage {
  Tally angle, smoothed;  ///< within a turn
  Tally counted;          ///< of the angle including whole turns
  Tally speed;
  std::size_t recordings = 0, never_found = 0;
  std::size_t slipped = 0;   ///< recordings with a final error of a turn or more
  std::size_t silently = 0;  ///< of these, without a note and within three standard deviations
};

/// Coverage over recordings `first` … `first + count − 1`, at `epochs` times of each from six
/// seconds on.
[[nodiscard]] LiveCoverage live_coverage_of(const Scenario& scenario,
                                            std::uint64_t first,
                                            int count,
                                            bool verbose = false);

}  // namespace proofmass::wheel_world
