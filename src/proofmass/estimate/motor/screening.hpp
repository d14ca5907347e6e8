#pragma once

#include <vector>

#include "proofmass/estimate/motor.hpp"

namespace proofmass::estimate::motor {

/// The record with what cannot be used made NaN, or left out, and a warning for each:
///
/// - single outliers of any column: further outside the two values before and the two after than
///   noise and motion explain, if they are at most 1 % of the column;
/// - a current whose converter has steps too coarse beside it.
[[nodiscard]] MotorRecord screened(const MotorRecord& record, std::vector<Note>& notes);

}  // namespace proofmass::estimate::motor
