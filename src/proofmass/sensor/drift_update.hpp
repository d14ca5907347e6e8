#pragma once

#include <cstddef>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Warm-up of one axis as identified from a recording: a1 (1 − e^(−t/T)) + a2, t since power-on. a2
/// is the level at power-on as recorded; for an axis with a gravity component it includes gravity.
/// Estimators remove the part that does not depend on it, see departure() in warm_up.hpp.
struct MeasuredDrift {
  std::size_t axis = 0;  ///< 0, 1, 2 for x, y, z
  Uncertain a1_mps2, a2_mps2, time_constant_s;
  std::string origin;  ///< "proofmass drift static.csv, 2 h at 100 Hz"
};

/// Stores the three figures of each axis in the model; other axes are unchanged.
///
/// Errors: invalid_argument (an axis twice, a negative std, T not positive), not_finite. The model
/// is then unchanged.
[[nodiscard]] Status update_drift(SensorModel& model, View<MeasuredDrift> measured);

/// The same in a sensor file. Everything else in it is kept, except comments; a missing file is
/// created, with the sensor named after it.
/// Errors: as above, and those of read_sensor_file and write_sensor_file. The file is then
/// unchanged.
[[nodiscard]] Status update_sensor_file(const std::string& path, View<MeasuredDrift> measured);

}  // namespace proofmass::sensor
