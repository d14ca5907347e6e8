#pragma once

#include <optional>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// A sensor model for those who do not read sensor files.
namespace proofmass::sensor {

struct ImuYamlOptions {
  std::optional<double> rate_hz;  ///< of the recordings to come; left to fill in where not given
  std::string rostopic = "/imu0";
};

/// The IMU description of the visual-inertial calibration tools, YAML. It has one number for all
/// axes, which is that of the worst; the three stand beside it in comments. What an accelerometer's
/// sensor file does not know, or the recordings could not tell, is commented out with the reason.
/// Source: Kalibr's wiki, "IMU Noise Model" (densities are two-sided, those of the Allan curve).
///
/// Errors: invalid_argument (noise.white is missing on an axis, or the rate is not positive),
/// not_observable (noise.white is 0: it was not identified).
[[nodiscard]] Result<std::string> imu_yaml(const SensorModel& model, const ImuYamlOptions& options);

/// A C99 header for firmware, which C++ reads too: bias and matrix of f = M (reading − bias), noise
/// coefficients and electrical constants as floats in SI, names and include guard from the sensor's
/// name. A bias or scale that is not known is 0 or 1, as for apply(); any other array that lacks an
/// axis is left out, so that nothing can be compiled that is not known.
///
/// Errors: invalid_argument (units of the calibration that do not go together, a scale that is 0 or
/// missing where the reading is not an acceleration, a figure too large for a float).
[[nodiscard]] Result<std::string> c_header(const SensorModel& model);

}  // namespace proofmass::sensor
