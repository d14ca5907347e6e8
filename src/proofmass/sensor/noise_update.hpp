#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// One identified coefficient: its value, or an upper bound, or neither.
struct MeasuredCoefficient {
  std::optional<Uncertain> identified;
  std::optional<double> upper_95;  ///< used if the coefficient is not identified
};

/// Noise of one axis, in the SI units of NoiseModel.
struct MeasuredNoise {
  std::size_t axis = 0;  ///< 0, 1, 2 for x, y, z
  MeasuredCoefficient white, quantisation, flicker, random_walk, ramp;
  std::optional<Uncertain> bandwidth_hz;
  std::optional<Figure> lsb;  ///< V or m/s^2
  std::string origin;         ///< "proofmass noise static.csv, 2 h at 100 Hz"
  /// The axis is the gyroscope's: white, flicker and random_walk are stored in
  /// SensorModel::gyroscope, in rad/s/sqrt(Hz), rad/s and rad/s/sqrt(s); the others are not.
  bool gyroscope = false;
};

/// Stores the figures in the model. A coefficient with only an upper bound is set to 0, with std =
/// upper_95 / 1.645 and an origin that ends "below … (95 %)"; one with neither is unchanged.
/// Bandwidth and LSB are set only if the model has none.
///
/// Errors: invalid_argument (an axis of one sensor twice, an LSB neither in V nor in m/s^2, a
/// negative figure), not_finite. The model is then unchanged.
[[nodiscard]] Status update_noise(SensorModel& model, View<MeasuredNoise> measured);

/// The same in a sensor file. Everything else in it is kept, except comments; a missing file is
/// created, with the sensor named after it.
/// Errors: as above, and those of read_sensor_file and write_sensor_file. The file is then
/// unchanged.
[[nodiscard]] Status update_sensor_file(const std::string& path, View<MeasuredNoise> measured);

}  // namespace proofmass::sensor
