#pragma once

#include <Eigen/Core>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// Error of one sensor file relative to another.
namespace proofmass::sensor {

/// v(u) = matrix u + offset.
struct Affine {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& u) const {
    return matrix * u + offset;
  }
};

/// e(u) of calibration_effect.hpp, in m/s^2 at 1 g, for readings in the given unit: "m/s^2", "V" or
/// "counts". Errors: invalid_argument (a file cannot be applied to such readings).
[[nodiscard]] Result<Affine> error_between(const SensorModel& before,
                                           const SensorModel& after,
                                           const std::string& unit);

/// A unit of readings to which both files can be applied: that of one of the calibrations, or else
/// the rawest; if there is none, that of `after`.
[[nodiscard]] std::string common_unit(const SensorModel& before, const SensorModel& after);

}  // namespace proofmass::sensor
