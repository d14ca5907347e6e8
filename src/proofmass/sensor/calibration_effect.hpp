#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// The largest error over all orientations, and where it is.
struct LargestError {
  double value = 0.0;
  std::optional<double> std;  ///< of the value; absent where a figure has none
  /// What 95 % of pairs of calibrations of one unchanged sensor would stay below.
  std::optional<double> by_chance_95;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< unit vector of the force in the sensor's axes
};

/// What it would do to use one sensor file instead of another on a sensor at rest.
struct CalibrationEffect {
  LargestError force_mps2;   ///< |f_old − f|
  LargestError angle_rad;    ///< between f_old and f
  std::string reading_unit;  ///< of the readings to which both files were applied
  std::string without_std;   ///< why std and by_chance_95 are absent; else empty
};

/// The error of f = g u, |u| = 1, that `before` makes of the reading of which `after` makes f:
///
///     e(u) = P_old P_new⁻¹ (g u − q_new) + q_old − g u,     f = P · reading + q by apply(),
///
/// at its largest over all u, with g = 9.80665 m/s² (1 g); and the angle likewise. Its standard
/// deviation is linear in the figures, from both covariances (or the figures' own deviations), the
/// two calibrations being independent save for figures that are the same entry in both. The
/// reading is of the unit of one of the calibrations, or else the rawest to which both apply. A
/// figure that a file does not have counts as apply() counts it, and is exact.
/// Source: for by_chance_95, JCGM 101:2008 (propagation of distributions), 4000 draws from a fixed
/// seed, the scatter of Student's t where `calibration.dof` is known.
///
/// Errors: invalid_argument (the two cannot be applied to readings of one unit).
/// Cost: some 50 ms.
[[nodiscard]] Result<CalibrationEffect> calibration_effect(const SensorModel& before,
                                                           const SensorModel& after);

/// True where both files hold the same entry: a figure that was carried over, not measured twice.
[[nodiscard]] bool carried_over(const std::optional<Figure>& before,
                                const std::optional<Figure>& after);

}  // namespace proofmass::sensor
