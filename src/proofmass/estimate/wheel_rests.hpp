#pragma once

#include "proofmass/estimate/wheel_fit.hpp"

// Where a wheel is at rest. Private to the module's wheel_*.cpp.
namespace proofmass::estimate {

/// Sets WheelInstant::stands. A wheel stands for half a second or longer where each axis of each
/// sensor keeps its value: a straight line through the measurements has no slope that a speed of
/// 0.05 rad/s would give it, and they scatter about the line as they do from one to the next.
void mark_standing(WheelReadings& readings);

}  // namespace proofmass::estimate
