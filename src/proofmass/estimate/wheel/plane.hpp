#pragma once

#include <array>
#include <optional>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/estimate/wheel/readings.hpp"

// From a sensor's data to measurements in the plane of its wheel.
namespace proofmass::estimate {

using Axis = std::array<double, 3>;

/// The usable rows of a sensor, and the reason for each interval of unusable ones.
struct Screened {
  std::vector<bool> usable;
  std::vector<Stretch> rejected;
  std::size_t unusable = 0;
};

/// Beyond the range of any accelerometer and gyroscope.
inline constexpr double beyond_belief_mps2 = 1000.0 * standard_gravity_mps2;
inline constexpr double beyond_belief_radps = 1e4;

/// Why a measurement is implausible: not finite, beyond 1000 g, denormal (below 1e-30 and not 0:
/// not a valid number), all axes exactly 0. nullptr if it is plausible.
[[nodiscard]] const char* why_unbelievable(const Axis& accel_mps2);

/// Drops rows that are implausible, or whose time does not ascend.
[[nodiscard]] Screened screen_rows(const WheelSensor& sensor);

/// The plane of the wheel in a sensor's axes: u, v span it, v a quarter turn ahead of u about
/// `axis`.
struct WheelPlane {
  Axis axis{}, u{}, v{};
  bool assumed = false;  ///< the wheel hardly turned: any level axis fits as well
  /// Mean force along the axis: gravity's component, if the axle is not level.
  double axial_mps2 = 0.0;
};

/// The axis along which the force changes least: gravity rotates about it and the centripetal force
/// is orthogonal to it. Its sign is that of its largest component, so that it lies near +x, +y or
/// +z; u is the next sensor axis in the order x, y, z, x, orthogonalised to it. Errors:
/// too_few_samples (fewer than 10 usable rows), invalid_argument (`given` has length 0),
/// not_observable (the force changes along one direction only).

[[nodiscard]] Result<WheelPlane> find_plane(const WheelSensor& sensor,
                                            const Screened& screened,
                                            const std::optional<Axis>& given);

/// Gravity's component in the plane of the wheel, m/s². A mean force along the axis is the axle's
/// tilt or the sensor's bias: nine axles in ten are level within `tilt_std_rad`, the tenth has any
/// tilt. `axial_read` is false for a two-axis sensor, which does not measure the tilt.
[[nodiscard]] Uncertain gravity_in_plane(const WheelPlane& plane,
                                         bool axial_read,
                                         double gravity_mps2,
                                         double tilt_std_rad);

/// The same plane seen from its other side: the wheel turns the other way.
[[nodiscard]] WheelPlane turned_over(const WheelPlane& plane);

[[nodiscard]] PlanarReadings project(const WheelSensor& sensor,
                                     const Screened& screened,
                                     const WheelPlane& plane);

}  // namespace proofmass::estimate
