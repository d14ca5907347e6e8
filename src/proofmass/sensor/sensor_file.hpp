#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// A sensor model as read, and what a person should know of the file: entries that mean nothing to
/// this version (they stay in SensorModel::unknown).
struct SensorFile {
  SensorModel model;
  std::vector<Note> notes;
};

/// Reads a sensor file (TOML): sections sensor, electrical, calibration, noise, drift. A figure is
///
///     white = { value = 1.04e-3, std = 2e-5, unit = "m/s^2/sqrt(Hz)", origin = "noise, run 3" }
///
/// with arrays of three for the axes x, y, z in `value` and `std` (one number stands for all
/// three), or an array of three such tables, of which {} is an axis that is not known.
/// Errors: unreadable, corrupt (no TOML, or a key whose value cannot be what it is for; the message
/// names file, line and key).
[[nodiscard]] Result<SensorFile> read_sensor_file(const std::string& path);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Result<SensorFile> parse_sensor_file(std::string_view text, std::string_view name);

/// The text of a sensor file that reads back as the same model, bit for bit.
[[nodiscard]] std::string format_sensor_file(const SensorModel& model);

/// Writes it beside `path` first and then renames, so that no reader sees half a file.
/// Errors: unwritable (cannot be written).
[[nodiscard]] Status write_sensor_file(const SensorModel& model, const std::string& path);

}  // namespace proofmass::sensor
