#pragma once

#include "proofmass/estimate/motor/parameters.hpp"
#include "proofmass/estimate/motor/series.hpp"

namespace proofmass::estimate::motor {

/// Initial values by linear least squares, u = R i + K ω at each sample and the balance of impulse
/// over windows of 0.25 s of motion; and priors as wide as the size of voltage, torque and speed
/// allow.
[[nodiscard]] Parameters start(const Series& series, const Regimes& regimes);

}  // namespace proofmass::estimate::motor
