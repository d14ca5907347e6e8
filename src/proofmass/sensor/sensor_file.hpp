#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// A sensor model as read, and notes on the file: entries unknown to this version (they are kept in
/// SensorModel::unknown).
struct SensorFile {
  SensorModel model;
  std::vector<Note> notes;
};

/// Reads a sensor file (TOML): sections sensor, electrical, calibration, noise, drift. A figure is
///
///     white = { value = 1.04e-3, std = 2e-5, unit = "m/s^2/sqrt(Hz)", origin = "noise, run 3" }
///
/// with arrays of three for the axes x, y, z in `value` and `std` (one number applies to all
/// three), or an array of three such tables, in which {} is an unknown axis.
/// Errors: unreadable, corrupt (not TOML, or a key with an invalid value; the message names file,
/// line and key).
[[nodiscard]] Result<SensorFile> read_sensor_file(const std::string& path);

/// The same from text; `name` is the file name in messages.
[[nodiscard]] Result<SensorFile> parse_sensor_file(std::string_view text, std::string_view name);

/// The text of a sensor file that parses to the same model, bit for bit.
[[nodiscard]] std::string format_sensor_file(const SensorModel& model);

/// Writes to a temporary file beside `path`, then renames it, so that no reader sees a partial
/// file.
/// Errors: unwritable (cannot be written).
[[nodiscard]] Status write_sensor_file(const SensorModel& model, const std::string& path);

}  // namespace proofmass::sensor
