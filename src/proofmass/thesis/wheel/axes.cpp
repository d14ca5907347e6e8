#include "proofmass/thesis/wheel/axes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "proofmass/core/so3.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::thesis {
namespace {

constexpr double near_rad = 0.5;
constexpr double well_known_rad = 0.05;

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, rad_per_turn);
}

// As estimate/wheel.hpp counts: the next sensor axis in the order x, y, z, x, made square to it.
Eigen::Vector3d first_in_plane(const Eigen::Vector3d& axis) {
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  const Eigen::Vector3d next = Eigen::Vector3d::Unit((largest + 1) % 3);
  return (next - axis.dot(next) * axis).normalized();
}

/// With the radius held, at one speed the bias is not separable from the mounting and its std is
/// too small: the builder's values are then more reliable.
bool is_known(const WheelRecord& record, const std::optional<Uncertain>& mounting_rad) {
  return !record.radius_m && mounting_rad && mounting_rad->std < well_known_rad;
}

bool equally_far(const estimate::WheelSensorFit& a, const estimate::WheelSensorFit& b) {
  return !a.radius_m || !b.radius_m ||
         std::abs(a.radius_m->value - b.radius_m->value) < 0.2 * a.radius_m->value;
}

void place_second(const WheelRecord& record,
                  const estimate::WheelSolution& solution,
                  WheelGeometry& geometry) {
  const auto& first = solution.sensors[0];
  const auto& second = solution.sensors[1];
  if (!second.phase_rad) return;
  const double phase_rad = geometry.sense * second.phase_rad->value;
  geometry.turned_rad[1] = geometry.turned_rad[0] + phase_rad;
  if (!equally_far(first, second)) return;
  if (is_known(record, first.mounting_rad) && is_known(record, second.mounting_rad)) {
    const double between_rad = geometry.turned_rad[1] - geometry.sense * second.mounting_rad->value;
    geometry.opposite = std::abs(wrapped(between_rad - std::numbers::pi)) < near_rad;
  } else if (record.radius_m && std::abs(wrapped(2.0 * phase_rad)) < 2.0 * near_rad) {
    geometry.opposite = true;
    geometry.notes.push_back(record.source +
                             ": the two sensors are taken to sit opposite each other");
  }
}

}  // namespace

WheelGeometry rig_geometry() {
  return {.turned_rad = {0.0, std::numbers::pi}, .opposite = true};
}

WheelGeometry geometry_of(const WheelRecord& record, const estimate::WheelSolution& solution) {
  if (record.simulated) return rig_geometry();
  WheelGeometry geometry{.turned_rad = std::vector<double>(record.sensors.size(), 0.0)};
  if (solution.turns && solution.turns->value < 0.0) geometry.sense = -1.0;
  if (is_known(record, solution.sensors.front().mounting_rad)) {
    geometry.turned_rad[0] = geometry.sense * solution.sensors.front().mounting_rad->value;
  } else {
    geometry.notes.push_back(record.source +
                             ": the first in-plane axis of the first sensor is taken to point "
                             "outward, which this recording does not show well");
  }
  if (record.sensors.size() == 2) place_second(record, solution, geometry);
  return geometry;
}

std::array<std::vector<double>, 2> outward_forward(const estimate::WheelSensor& sensor,
                                                   const std::array<double, 3>& spin_axis,
                                                   double turned_rad,
                                                   double sense) {
  const Eigen::Vector3d axis = Eigen::Vector3d::Map(spin_axis.data()).normalized();
  const Eigen::Vector3d u = first_in_plane(axis), v = sense * cross(axis, u);
  const Eigen::Vector3d outward = std::cos(turned_rad) * u - std::sin(turned_rad) * v;
  const Eigen::Vector3d forward = std::sin(turned_rad) * u + std::cos(turned_rad) * v;
  std::array<std::vector<double>, 2> out;
  for (std::vector<double>& along : out) along.resize(sensor.time_s.size());
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) {
    Eigen::Vector3d f = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      if (!sensor.accel_mps2[i].empty()) f(static_cast<Eigen::Index>(i)) = sensor.accel_mps2[i][k];
    out[0][k] = outward.dot(f);
    out[1][k] = forward.dot(f);
  }
  return out;
}

}  // namespace proofmass::thesis
