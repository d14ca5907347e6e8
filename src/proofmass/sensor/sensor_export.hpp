#pragma once

#include <optional>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// Exports of a sensor model to other formats.
namespace proofmass::sensor {

struct ImuYamlOptions {
  std::optional<double> rate_hz;  ///< rate of future recordings; left blank for the user if absent
  std::string rostopic = "/imu0";
};

/// The IMU description of visual-inertial calibration tools, YAML. It has one number for all axes:
/// the largest, with the three values in comments. Entries that the sensor file lacks, or
/// that were not identified, are commented out with the reason.
/// Source: Kalibr's wiki, "IMU Noise Model" (densities are two-sided, those of the Allan curve).
///
/// Errors: invalid_argument (noise.white is missing on an axis, or the rate is not positive),
/// not_observable (noise.white is 0: it was not identified).
[[nodiscard]] Result<std::string> imu_yaml(const SensorModel& model, const ImuYamlOptions& options);

/// A C99 header for firmware, also valid C++: bias and matrix of f = M (reading − bias), noise
/// coefficients and electrical constants as floats in SI, names and include guard from the sensor's
/// name. An unknown bias or scale is 0 or 1, as in apply(); any other array with a missing axis is
/// omitted, so that code using an unknown value does not compile.
///
/// Errors: invalid_argument (inconsistent units of the calibration, a scale that is 0 or missing
/// although the reading is not an acceleration, a figure too large for a float).
[[nodiscard]] Result<std::string> c_header(const SensorModel& model);

}  // namespace proofmass::sensor
