#pragma once

#include <vector>

#include "proofmass/estimate/wheel/fit.hpp"

// Possible numbers of turns of a wheel during gaps.
namespace proofmass::estimate {

/// The fit's number of turns, and those a whole number away, with their probability, by falling
/// probability; those below 1 % are omitted. Gravity determines the angle before and after an
/// ambiguous interval up to whole turns, and so the speed on both sides. Given these, the angle at
/// its end is predicted with mean m and variance V by the motion model, and n additional turns have
/// a weight of exp(−(θ + 2πn − m)² / 2V). Intervals are independent. Empty without an ambiguous
/// interval, or if there are too many possibilities.
[[nodiscard]] std::vector<TurnsCandidate> turns_candidates(const WheelFit& fit);

}  // namespace proofmass::estimate
