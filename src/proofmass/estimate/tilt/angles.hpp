#pragma once

#include <array>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"

// Angles from the specific force of a sensor at rest.
//
// World axes have z upwards, and R_world_sensor = Rz(heading) Ry(pitch) Rx(roll), right-handed. At
// rest the accelerometer measures the specific force, +g along the upward direction:
//
//     f = g (−sin pitch, cos pitch · sin roll, cos pitch · cos roll).
//
// Roll is positive where y goes up, pitch where x goes down; both are 0 where z points up.
namespace proofmass::estimate {

/// Inclination of the sensor axis nearest to the vertical, which stays defined where roll is not.
struct Inclination {
  std::size_t axis = 2;  ///< 0, 1, 2: x, y, z
  bool up = true;        ///< it points up rather than down
  Uncertain angle_rad;   ///< from the vertical, 0 … 55°
  /// Azimuth of the upward vertical in the plane of the other two axes: from y to z for x, from z
  /// to x for y, from x to y for z. Absent if the angle is below two of its standard deviations.
  std::optional<Uncertain> azimuth_rad;
};

/// Angles with standard deviations, or the reason for their absence.
struct TiltAngles {
  std::optional<Uncertain> roll_rad, pitch_rad;
  std::string why_no_roll, why_no_pitch;
  /// Elevation of each axis above the horizon, if it was recorded and is not nearly vertical.
  std::array<std::optional<Uncertain>, 3> elevation_rad;
  std::optional<Inclination> inclination;  ///< with three axes only
};

/// roll = atan2(f_y, f_z), pitch = atan2(−f_x, √(f_y² + f_z²)), to first order in the covariance.
/// Roll is absent if x is so nearly vertical that its standard deviation exceeds 0.5 rad, pitch if
/// that of the direction does. Source: M. Pedley, Tilt Sensing Using a Three-Axis Accelerometer
/// (2013), equations 25 and 26, in axes with z upwards. f = 0 gives no angles.
[[nodiscard]] TiltAngles angles_of(const Mat<3>& force, const Mat<3, 3>& cov);

/// Angles from one or two axes; the others are NaN in `force`. With sin(elevation) = f / g: x gives
/// pitch, y with z give roll, and x with y give roll if z points up. Angles that the missing axis
/// leaves ambiguous (a sign) are absent, with the reason.
[[nodiscard]] TiltAngles angles_of_some(const Mat<3>& force,
                                        const Mat<3, 3>& cov,
                                        const Uncertain& gravity_mps2);

}  // namespace proofmass::estimate
