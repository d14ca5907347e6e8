#pragma once

#include <vector>

#include "proofmass/estimate/wheel_fit.hpp"

// The numbers of turns that a wheel may have made where nothing was read. Private to the module's
// wheel_*.cpp.
namespace proofmass::estimate {

/// The fit's number of turns, and those a whole number away, with their probability, by falling
/// probability; those below 1 % are left out. Gravity gives the angle before and after a doubt but
/// for whole turns, and so the speed on both sides. Given these, the angle at the end of the doubt
/// is predicted with mean m and variance V by the model of the motion, and n turns more have a
/// weight of exp(−(θ + 2πn − m)² / 2V). Doubts are independent.
/// Empty where there is no doubt, or where the turns left open are too many to list.
[[nodiscard]] std::vector<TurnsCandidate> turns_candidates(const WheelFit& fit);

}  // namespace proofmass::estimate
