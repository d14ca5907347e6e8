#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/fleet/random_effects.hpp"

namespace proofmass::fleet {

/// Sensors about a mean of 3: τ between, σ within, `counts` values each.
inline std::vector<SensorValues> drawn_fleet(Random& random,
                                             double between,
                                             double within,
                                             const std::vector<std::size_t>& counts) {
  std::vector<SensorValues> sensors;
  for (const std::size_t count : counts) {
    const double mean = 3.0 + between * random.normal();
    SensorValues& sensor = sensors.emplace_back();
    for (std::size_t k = 0; k < count; ++k)
      sensor.values.push_back(mean + within * random.normal());
  }
  return sensors;
}

inline bool holds(const Bounds& bounds, double value) {
  return bounds.lower <= value && value <= bounds.upper;
}

/// In how many of the fleets the intervals hold.
struct Coverage {
  std::size_t mean = 0, between = 0, within = 0;
};

}  // namespace proofmass::fleet
