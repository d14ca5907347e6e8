#pragma once

#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::estimate {

/// A wheel's motion as one sensor alone tells it.
struct WheelMotion {
  const std::vector<double>* time_s = nullptr;
  const std::vector<double>* angle_rad = nullptr;
  const std::vector<double>* speed_radps = nullptr;
};

/// How two sensors of one wheel lie to each other: second(t + offset) = first(t) + phase.
struct ClockFit {
  Uncertain offset_s;  ///< to be taken from the second's stamps to have the first's
  double phase_rad = 0.0;
};

/// Lays the second sensor's angle over the first's. At one speed an offset of the clocks and a
/// phase between the sensors are the same thing; where the speed changes, the difference of the
/// angles goes with the speed, and its slope is the offset. With `clocks_shared` only offsets up to
/// a tenth of a second are looked for, unless the speeds agree far better elsewhere. The offset's
/// standard deviation is from the scatter between tenths of the recording. Errors: not_observable
/// (they share no time, or the speed hardly changes).
[[nodiscard]] Result<ClockFit> fit_clocks(const WheelMotion& first,
                                          const WheelMotion& second,
                                          bool clocks_shared);

}  // namespace proofmass::estimate
