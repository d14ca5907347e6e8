#include "proofmass/core/directions.hpp"

#include <cmath>
#include <numbers>

namespace proofmass {

std::vector<Eigen::Vector3d> spread_directions(std::size_t count) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double z = 1.0 - static_cast<double>(2 * k + 1) / static_cast<double>(count);
    const double radius = std::sqrt(1.0 - z * z);
    const double angle = static_cast<double>(k) * golden_angle;
    directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return directions;
}

}  // namespace proofmass
