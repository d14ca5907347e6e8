#pragma once

#include "proofmass/estimate/motor.hpp"
#include "proofmass/estimate/motor/scoring.hpp"

namespace proofmass::estimate::motor {

/// The drive's figures with intervals, and what the record does not determine.
[[nodiscard]] std::vector<MotorParameter> conclude(const Series& series,
                                                   const Regimes& regimes,
                                                   const Fit& fit);

/// Friction over the speeds of the record.
[[nodiscard]] std::vector<FrictionPoint> friction_curve(const Series& series,
                                                        const Regimes& regimes,
                                                        const Fit& fit);

/// True if the gear has borne on both flanks.
[[nodiscard]] bool saw_both_flanks(const Regimes& regimes);

}  // namespace proofmass::estimate::motor
