#pragma once

#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::estimate {

struct LostInterval {
  double from_s = 0.0, to_s = 0.0;
};

/// A wheel's motion estimated by one sensor alone. Where its angle was lost, its speed is unknown
/// and its angle afterwards is known but for whole turns.
struct WheelMotion {
  const std::vector<double>* time_s = nullptr;
  const std::vector<double>* angle_rad = nullptr;
  const std::vector<double>* speed_radps = nullptr;
  std::vector<LostInterval> lost = {};
};

/// Alignment of two sensors of one wheel: second(t + offset) = first(t) + phase.
struct ClockFit {
  Uncertain offset_s;  ///< subtract from the second's stamps
  double phase_rad = 0.0;
};

/// Aligns the second sensor's angle with the first's. At one speed a clock offset and a phase
/// between the sensors are not separable; if the speed changes, the difference of the angles is
/// linear in the speed, with the offset as slope. With `clocks_shared` only offsets up to a tenth
/// of a second are considered, unless the speeds agree far better elsewhere. The offset's standard
/// deviation is from the scatter between tenths of the recording. Errors: not_observable (they have
/// no common time, or the speed hardly changes).
[[nodiscard]] Result<ClockFit> fit_clocks(const WheelMotion& first,
                                          const WheelMotion& second,
                                          bool clocks_shared);

/// The phase alone, of sensors with one clock. Errors: not_observable (no common time).
[[nodiscard]] Result<ClockFit> fit_phase(const WheelMotion& first, const WheelMotion& second);

}  // namespace proofmass::estimate
