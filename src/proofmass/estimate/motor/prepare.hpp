#pragma once

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/motor.hpp"
#include "proofmass/estimate/motor/series.hpp"

namespace proofmass::estimate::motor {

/// The record on an even grid of at most `most_rate_hz`, the angle positive with the voltage.
/// Errors: as estimate_motor().
[[nodiscard]] Result<Series> prepare(const MotorRecord& record, const MotorOptions& options);

}  // namespace proofmass::estimate::motor
