#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel.hpp"

// Path of a vehicle from sensors on its wheels, with or without position fixes.
namespace proofmass::estimate {

inline constexpr std::size_t most_drive_wheels = 4;

enum class VehicleSide { right, left };

/// One wheel, measured by an accelerometer (and gyroscope) that turns with it, or by an encoder.
struct DriveWheel {
  WheelSensor sensor;  ///< of an encoder: name and time_s only
  /// Encoder: angle of the wheel, as long as sensor.time_s, NaN where missing; empty: no encoder.
  std::vector<double> encoder_rad{};
  VehicleSide side = VehicleSide::right;
  /// On the steered axle; without a value it is determined from the recordings where they differ.
  std::optional<bool> steered{};
  std::optional<Uncertain> circumference_m{};  ///< rolling circumference under load
  /// Recordings with the same number were stamped by one clock; sensor.time_s are its readings.
  int clock = 0;
};

/// An inertial sensor on the vehicle's frame, whose gyroscope measures the yaw rate.
struct DriveFrame {
  WheelSensor sensor;
  int clock = 0;
};

/// One position fix. A receiver's repeated fix is one fix, at the time of its first row.
struct GnssFix {
  double time_s = 0.0;
  double latitude_rad = 0.0, longitude_rad = 0.0;
  double std_m = std::numeric_limits<double>::quiet_NaN();  ///< horizontal, per axis; NaN: unstated
};

/// Position fixes of one receiver, by ascending time.
struct GnssFixes {
  std::string name;
  std::vector<GnssFix> fixes;
};

struct DriveOptions {
  WheelOptions wheel{};                    ///< for each wheel's angle: gravity, bandwidth, tilt
  std::optional<Uncertain> track_m{};      ///< between the wheels of an axle
  std::optional<Uncertain> wheelbase_m{};  ///< between the axles
  Progress progress;
};

struct DriveWheelFit {
  std::string name;
  VehicleSide side = VehicleSide::right;
  bool steered = false;
  std::optional<Uncertain> turns{};            ///< forward positive, over its own recording
  std::optional<Uncertain> circumference_m{};  ///< rolling
  bool has_yaw = false;                        ///< its gyroscope gave the vehicle's yaw rate
  double spin_tilt_rad = 0.0;  ///< between gyroscope's and accelerometer's spin axis and its own
  std::optional<Uncertain> clock_offset_s{};  ///< its clock's reading minus the first wheel's
};

/// Fixes, as they were used.
struct DriveFixesFit {
  std::string name;
  std::size_t fixes = 0, used = 0;        ///< distinct fixes; those not rejected by the gate
  double time_scale = 1.0;                ///< seconds for one second of its stamps
  double noise_m = 0.0;                   ///< white part of the error, per axis
  double wander_m = 0.0, wander_s = 0.0;  ///< slowly varying part: std per axis, and time
  double path_m = 0.0;                    ///< length of the line through the fixes
  std::optional<Uncertain> clock_offset_s{};
};

/// The path at each epoch, in metres from the start. With fixes x is east and y north; without, x
/// is the direction of the vehicle at the start and y to its left.
struct DriveSeries {
  std::vector<double> time_s;
  std::vector<double> x_m, y_m, heading_rad;  ///< heading from x towards y
  std::vector<double> x_std_m, y_std_m, xy_cov_m2, heading_std_rad;
  std::vector<double> speed_mps, speed_std_mps, rate_radps, distance_m;
};

struct DriveSolution {
  std::optional<Uncertain> distance_m;            ///< path length of the reference point
  std::optional<Uncertain> heading_change_rad;    ///< end minus start, a left turn positive
  std::optional<Uncertain> heading_start_rad;     ///< from east, to the north positive
  std::array<std::optional<Uncertain>, 2> end_m;  ///< end minus start
  std::optional<Uncertain> closure_m;             ///< distance of the end from the start
  std::string reference_point;
  std::array<double, 2> origin_deg{};  ///< latitude and longitude of the start, with fixes
  bool has_fixes = false;
  std::optional<Uncertain> track_m, wheelbase_m;
  std::vector<DriveWheelFit> wheels;
  std::optional<DriveFixesFit> fixes;
  std::optional<Uncertain> frame_clock_offset_s;
  double slip_m_per_rtm = 0.0;  ///< random walk of a wheel's rolled distance
  double nis = 0.0;             ///< mean of innovation² / variance; 1 expected
  std::vector<std::string> not_observable;
  std::vector<Note> notes;
  DriveSeries series;
};

/// Path of a vehicle from its wheels: the angle of each from gravity (wheel.hpp) or an encoder, the
/// yaw rate from gyroscopes on wheels or frame, else from the difference of the two sides. A
/// planar extended Kalman filter and smoother has rolling radii, track, wheelbase, clock offsets
/// and gyroscope scales as constants, and the fixes with an error that is correlated in time.
///
/// Source: X. Niu, Y. Wu, J. Kuang, Wheel-INS, IEEE Trans. Vehicular
/// Technology 70 (2021) 10671, for the wheel-mounted gyroscope; J. Borenstein, L. Feng, IEEE Trans.
/// Robotics and Automation 12 (1996) 869, for the errors of odometry.
///
/// Errors: invalid_argument (no wheel, more than four, a wrong length), those of estimate_wheel,
/// not_observable (no wheel's angle could be determined, the recordings have no common motion, the
/// path does not converge).
[[nodiscard]] Result<DriveSolution> estimate_drive(const std::vector<DriveWheel>& wheels,
                                                   const std::optional<DriveFrame>& frame,
                                                   const std::optional<GnssFixes>& fixes,
                                                   const DriveOptions& options);

}  // namespace proofmass::estimate
