#pragma once

#include "proofmass/estimate/wheel/fit.hpp"

// Static intervals of a wheel.
namespace proofmass::estimate {

/// Sets WheelEpoch::stands. A wheel is static for half a second or longer if each axis of each
/// sensor is constant: a straight line through the measurements has no slope as large as a speed of
/// 0.05 rad/s would cause, and their scatter about the line equals that between neighbours.
void mark_standing(WheelReadings& readings);

}  // namespace proofmass::estimate
