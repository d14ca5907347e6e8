#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// What a recording says of one coefficient: its value, or how large it is at most, or nothing.
struct MeasuredCoefficient {
  std::optional<Uncertain> identified;
  std::optional<double> upper_95;  ///< looked at where it is not identified
};

/// Noise of one axis, in the SI units of NoiseModel.
struct MeasuredNoise {
  std::size_t axis = 0;  ///< 0, 1, 2 for x, y, z
  MeasuredCoefficient white, quantisation, flicker, random_walk, ramp;
  std::optional<Uncertain> bandwidth_hz;
  std::optional<Figure> lsb;  ///< V or m/s^2
  std::string origin;         ///< "proofmass noise static.csv, 2 h at 100 Hz"
};

/// Puts the figures into the model. A coefficient that is only bounded becomes 0, with std =
/// upper_95 / 1.645 and an origin that ends "below … (95 %)"; of one of which nothing is said, the
/// model keeps what it has. Bandwidth and LSB are set only where the model has none.
///
/// Errors: invalid_argument (an axis twice, an LSB neither in V nor in m/s^2, a figure that is
/// negative), not_finite. The model is then as it was.
[[nodiscard]] Status update_noise(SensorModel& model, View<MeasuredNoise> measured);

/// The same in a sensor file, of which all else stays as it is, save comments; a file that is not
/// there is made, with the sensor named after it.
/// Errors: as above, and those of read_sensor_file and write_sensor_file. The file is then as it
/// was.
[[nodiscard]] Status update_sensor_file(const std::string& path, View<MeasuredNoise> measured);

}  // namespace proofmass::sensor
