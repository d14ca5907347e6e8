#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/thesis/wheel_runs.hpp"

// Outward and forward: the axes of the thesis's formulas.
namespace proofmass::thesis {

/// Mounting of a record's sensors on its wheel.
struct WheelGeometry {
  double sense = 1.0;  ///< −1: it turns negative about the first sensor's spin axis
  /// Angle of each sensor's first in-plane axis, about the axle in the direction of rotation, from
  /// the spoke of the first sensor.
  std::vector<double> turned_rad;
  bool opposite = false;                ///< the second sensor, as far from the axle as the first
  std::vector<std::string> notes = {};  ///< assumptions
};

/// Geometry of simulate_wheel()'s records.
[[nodiscard]] WheelGeometry rig_geometry();

/// From the wheel model's estimates; what it did not determine is assumed as on the thesis's rig (x
/// outward, two opposite sensors with parallel axes), and a note reports it.
[[nodiscard]] WheelGeometry geometry_of(const WheelRecord& record,
                                        const estimate::WheelSolution& solution);

/// Readings along the first sensor's spoke and forward, at each of the sensor's samples.
[[nodiscard]] std::array<std::vector<double>, 2> outward_forward(
    const estimate::WheelSensor& sensor,
    const std::array<double, 3>& spin_axis,
    double turned_rad,
    double sense);

}  // namespace proofmass::thesis
