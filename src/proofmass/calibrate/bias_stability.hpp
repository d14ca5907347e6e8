#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/calibrate/uncertainty/type_b.hpp"

// Repeatability of a bias between sessions.
namespace proofmass::calibrate {

/// Noise coefficients of each axis's bias, in the output's unit.
struct SlowNoiseStrengths {
  std::array<double, 3> flicker{};      ///< h of the one-sided spectrum h/f: B²/π
  std::array<double, 3> random_walk{};  ///< K², per second
};

struct BiasStability {
  std::array<double, 3> std{};  ///< in the output's unit
  std::string source;           ///< "flicker noise and random walk of sensor.toml"
};

/// Standard deviation of the mean bias of one session about the sensor's long-term bias: flicker
/// noise with periods from the session's length to 30 days, and the random walk over the session,
///
///     u² = h ln(30 days / T) + K² T/3.
///
/// Drift and ageing dominate beyond that time and are not described by noise; a random walk that
/// continues between the sessions would be unbounded.
[[nodiscard]] BiasStability stability_of(const SlowNoiseStrengths& slow_noise,
                                         double session_s,
                                         std::string source);

/// Its contributions to the bias budgets. reading_unit: "m/s^2", "V" or "counts".
[[nodiscard]] std::vector<TypeB> type_b_of(const BiasStability& stability,
                                           const std::string& reading_unit);

}  // namespace proofmass::calibrate
