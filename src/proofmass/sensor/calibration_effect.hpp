#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// The largest error over all orientations, and its orientation.
struct LargestError {
  double value = 0.0;
  std::optional<double> std;  ///< standard deviation of the value; absent if a figure has none
  /// 95 % bound for pairs of calibrations of one unchanged sensor.
  std::optional<double> by_chance_95;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< unit vector of the force in the sensor's axes
};

/// Effect on a static sensor of using one sensor file instead of another.
struct CalibrationEffect {
  LargestError force_mps2;   ///< |f_old − f|
  LargestError angle_rad;    ///< between f_old and f
  std::string reading_unit;  ///< unit of the readings to which both files were applied
  std::string without_std;   ///< the reason if std and by_chance_95 are absent; else empty
};

/// Largest error over all u, |u| = 1, of the force f = g u: the reading that `after` converts to f
/// is converted by `before` to f + e(u),
///
///     e(u) = P_old P_new⁻¹ (g u − q_new) + q_old − g u,     f = P · reading + q by apply(),
///
/// with g = 9.80665 m/s² (1 g); likewise the largest angle.
///
/// - The standard deviation is linear in the figures, from both covariances (or the figures' own
///   standard deviations). The two calibrations are independent except for figures that are the
///   same entry in both.
/// - The unit of the reading is that of one of the calibrations, or else the rawest to which both
///   apply.
/// - A figure missing from a file has the default of apply() and no uncertainty.
///
/// Source: for by_chance_95, JCGM 101:2008 (propagation of distributions), 4000 draws from a fixed
/// seed, with the scatter of Student's t if `calibration.dof` is known.
///
/// Errors: invalid_argument (the two cannot be applied to readings of one unit).
/// Cost: about 50 ms.
[[nodiscard]] Result<CalibrationEffect> calibration_effect(const SensorModel& before,
                                                           const SensorModel& after);

/// True if both files contain the same entry: a figure that was carried over, not measured twice.
[[nodiscard]] bool carried_over(const std::optional<Figure>& before,
                                const std::optional<Figure>& after);

}  // namespace proofmass::sensor
