#pragma once

#include <cstddef>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Warm-up of one axis as identified from a recording: a1 (1 − e^(−t/T)) + a2, t since switching
/// on. a2 is the level at switching on as it was recorded: where the axis saw gravity, with gravity
/// in it. Estimators take out the part that does not depend on it, see departure() in warm_up.hpp.
struct MeasuredDrift {
  std::size_t axis = 0;  ///< 0, 1, 2 for x, y, z
  Uncertain a1_mps2, a2_mps2, time_constant_s;
  std::string origin;  ///< "proofmass drift static.csv, 2 h at 100 Hz"
};

/// Puts the three figures of each axis into the model; the other axes keep what they have.
///
/// Errors: invalid_argument (an axis twice, a negative std, T not positive), not_finite. The model
/// is then as it was.
[[nodiscard]] Status update_drift(SensorModel& model, View<MeasuredDrift> measured);

/// The same in a sensor file, of which all else stays as it is, save comments; a file that is not
/// there is made, with the sensor named after it.
/// Errors: as above, and those of read_sensor_file and write_sensor_file. The file is then as it
/// was.
[[nodiscard]] Status update_sensor_file(const std::string& path, View<MeasuredDrift> measured);

}  // namespace proofmass::sensor
