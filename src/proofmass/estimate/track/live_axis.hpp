#pragma once

#include <array>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"
#include "proofmass/estimate/track/live_rests.hpp"
#include "proofmass/estimate/track/motion.hpp"

// The direction of an online displacement.
namespace proofmass::estimate {

/// Errors: invalid_argument (no direction, or one along an axis that the sensor lacks).
[[nodiscard]] Status check_live_axis(const Triad& sensor, const std::array<double, 3>& axis);

[[nodiscard]] Mat<3> unit_vector(const std::array<double, 3>& axis);

/// Direction of the highest speed in a motion, collected from the last epoch and the level of the
/// rest before it to the rest after it, or to now. Expects at least one measurement.
[[nodiscard]] FoundAxis axis_of_motion(const std::vector<LiveReading>& motion,
                                       const LiveReading& level,
                                       const Triad& sensor,
                                       bool stopped);

}  // namespace proofmass::estimate
