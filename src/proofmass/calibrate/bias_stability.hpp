#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/calibrate/type_b.hpp"

// How well a bias repeats from one session to another.
namespace proofmass::calibrate {

/// The wander of a bias on each axis, in the reading's unit.
struct WanderStrengths {
  std::array<double, 3> flicker{};      ///< h of the one-sided spectrum h/f: B²/π
  std::array<double, 3> random_walk{};  ///< K², per second
};

struct BiasStability {
  std::array<double, 3> std{};  ///< in the reading's unit
  std::string source;           ///< "flicker noise and random walk of sensor.toml"
};

/// What the mean bias of one session differs by from that of the sensor: flicker noise with periods
/// from the session's length to 30 days, and the random walk over the session,
///
///     u² = h ln(30 days / T) + K² T/3.
///
/// Longer than that drift and ageing act, which no noise describes; a walk that went on between the
/// sessions would have no end.
[[nodiscard]] BiasStability stability_of(const WanderStrengths& wander,
                                         double session_s,
                                         std::string source);

/// Its contributions to the budget of the biases. reading_unit: "m/s^2", "V" or "counts".
[[nodiscard]] std::vector<TypeB> type_b_of(const BiasStability& stability,
                                           const std::string& reading_unit);

}  // namespace proofmass::calibrate
