#pragma once

#include <array>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/estimate/gaussian.hpp"

// From the force that gravity leaves on a sensor to its angles.
//
// World axes have z upwards, and R_world_sensor = Rz(heading) Ry(pitch) Rx(roll), right-handed. At
// rest the accelerometer reads the specific force, +g along what points up:
//
//     f = g (−sin pitch, cos pitch · sin roll, cos pitch · cos roll).
//
// Roll is positive where y goes up, pitch where x goes down; both are 0 where z points up.
namespace proofmass::estimate {

/// Of the sensor axis that is nearest to the vertical: what stays defined where roll does not.
struct Inclination {
  std::size_t axis = 2;  ///< 0, 1, 2: x, y, z
  bool up = true;        ///< it points up rather than down
  Uncertain angle_rad;   ///< between it and the vertical, 0 … 55°
  /// Of the upward vertical in the plane of the other two axes: from y to z for x, from z to x for
  /// y, from x to y for z. Absent where the angle is below two of its standard deviations.
  std::optional<Uncertain> azimuth_rad;
};

/// Angles with standard deviations, or why there are none.
struct TiltAngles {
  std::optional<Uncertain> roll_rad, pitch_rad;
  std::string why_no_roll, why_no_pitch;
  /// Of each axis above the horizon, where it was recorded and not nearly upright.
  std::array<std::optional<Uncertain>, 3> elevation_rad;
  std::optional<Inclination> inclination;  ///< of three axes
};

/// roll = atan2(f_y, f_z), pitch = atan2(−f_x, √(f_y² + f_z²)), to first order in the covariance.
/// Roll is absent where x is so nearly upright that its standard deviation passes 0.5 rad, pitch
/// where that of the direction does.
/// Source: M. Pedley, Tilt Sensing Using a Three-Axis Accelerometer (2013), equations 25 and 26, in
/// axes with z upwards. None of f = 0.
[[nodiscard]] TiltAngles angles_of(const Mat<3>& force, const Mat<3, 3>& cov);

/// The same of one or two axes; the others are NaN in `force`. With sin(elevation) = f / g:
/// x gives pitch, y with z give roll, and x with y give roll if z points up; what else the missing
/// axis leaves open (a sign) is absent, with its reason.
[[nodiscard]] TiltAngles angles_of_some(const Mat<3>& force,
                                        const Mat<3, 3>& cov,
                                        const Uncertain& gravity_mps2);

}  // namespace proofmass::estimate
