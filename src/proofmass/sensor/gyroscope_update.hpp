#pragma once

#include <array>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Result of a gyroscope's calibration in the order of Gyroscope::covariance. Figures that were not
/// determined are absent.
struct MeasuredGyroscope {
  std::array<std::optional<Uncertain>, gyroscope_figures> figures;
  std::string reading_unit = "rad/s";  ///< "rad/s", "V" or "counts"
  std::optional<std::array<std::array<double, gyroscope_figures>, gyroscope_figures>> covariance;
  std::string origin;  ///< "proofmass calibrate turned.csv, 37 motions"
};

/// Replaces the gyroscope's calibration in the model; its noise stays. The covariance is kept only
/// if all figures were determined. Errors: not_finite, invalid_argument (a scale of 0, a negative
/// std, another unit). The model is then unchanged.
[[nodiscard]] Status update_gyroscope(SensorModel& model, const MeasuredGyroscope& measured);

/// The same in a sensor file; see update_calibration(path, …).
[[nodiscard]] Status update_gyroscope(const std::string& path, const MeasuredGyroscope& measured);

}  // namespace proofmass::sensor
