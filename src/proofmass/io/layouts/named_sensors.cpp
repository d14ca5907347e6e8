#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/io/archive/names.hpp"
#include "proofmass/io/layouts/layout.hpp"
#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

/// A sensor by the bare name of its file in Sensor Logger's exports, and its unit.
struct LoggedSensor {
  std::string_view file;
  std::string_view unit;
  std::string_view name;  ///< prefix of the axes; empty for an accelerometer
};
constexpr std::array logged_sensors = std::to_array<LoggedSensor>({
    {"accelerometer", "m/s^2", "Linear acceleration"},
    {"totalacceleration", "m/s^2", ""},
    {"gravity", "m/s^2", "Gravity"},
    {"gyroscope", "rad/s", "Gyroscope"},
    {"gyroscopeuncalibrated", "rad/s", "Gyroscope"},
    {"magnetometer", "uT", "Magnetometer"},
    {"magnetometeruncalibrated", "uT", "Magnetometer"},
});

/// Sensor names used in file names, independent of the program.
constexpr std::array<std::string_view, 7> sensors{
    "gyroscope", "magnetometer", "gyro", "gyr", "mag", "gravity", "linearacceleration"};

bool has_logged_columns(std::string_view header) {
  bool time = false;
  bool elapsed = false;
  for (std::size_t c = 0; c < 8; ++c) {
    const std::string name = field_of(header, ',', c);
    time = time || name == "time";
    elapsed = elapsed || name == "seconds_elapsed";
  }
  return time && elapsed;
}

/// The sensor of the file; nullptr if it is not one of Sensor Logger's with axes and a known unit.
const LoggedSensor* sensor_logged(const std::string& bare) {
  const auto* found = std::ranges::find(logged_sensors, bare, &LoggedSensor::file);
  return found == logged_sensors.end() ? nullptr : found;
}

/// "platform android, device Pixel 6" from Metadata.csv.
std::string device_logged(std::string_view text) {
  const auto lines = lines_of(text);
  if (lines.size() < 2) return {};
  std::string stated;
  for (std::size_t c = 0; c < 16; ++c) {
    const std::string name = field_of(lines[0], ',', c);
    const std::string value = plain_name(field_of(lines[1], ',', c)).substr(0, 60);
    if (value.empty()) continue;
    if (name == "device name" || name == "platform" || name == "appVersion")
      stated += (stated.empty() ? "" : ", ") + name + " " + value;
  }
  return stated;
}

/// "Manufacturer = LGE", "Model = Nexus 5"
std::string phone_in(std::string_view text) {
  std::string stated;
  for (const std::string_view line : lines_of(text)) {
    const std::string name = lower(field_of(line, '=', 0));
    if (name == "manufacturer" || name == "model")
      stated += (stated.empty() ? "" : " ") + plain_name(field_of(line, '=', 1)).substr(0, 60);
  }
  return stated;
}

/// Adds `text` as a note to all files in the folder of `one`, which is not a recording.
void note_beside(const Archive& archive,
                 std::size_t one,
                 const std::string& text,
                 ArchiveLayout& layout) {
  const auto entries = archive.entries();
  layout[one].is_recording = false;
  for (std::size_t e = 0; e < entries.size(); ++e)
    if (folder_part(entries[e].name) == folder_part(entries[one].name))
      layout[e].notes.push_back({Severity::info, text});
}

}  // namespace

void read_sensor_logger_layout(Archive& archive, ArchiveLayout& layout) {
  const auto entries = archive.entries();
  bool any = false;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const LoggedSensor* sensor =
        sensor_logged(bare_name(without_endings(file_part(entries[e].name))));
    if (sensor == nullptr) continue;
    const std::string text = text_of(archive, e);
    if (!has_logged_columns(std::string_view(text).substr(0, text.find('\n')))) continue;
    MemberHint& hint = layout[e];
    hint.sensor = sensor->name;
    hint.unit = sensor->unit;
    hint.notes.push_back(
        {Severity::info,
         fmt::format("unit of x, y and z {}, as Sensor Logger writes it{}", sensor->unit,
                     sensor->file == "accelerometer" ? "; gravity is taken from it" : "")});
    any = true;
  }
  for (std::size_t e = 0; any && e < entries.size(); ++e) {
    if (without_endings(file_part(entries[e].name)) != "Metadata") continue;
    const std::string device = device_logged(text_of(archive, e));
    if (!device.empty())
      note_beside(archive, e, "recorded by Sensor Logger (" + device + ")", layout);
  }
}

void read_named_sensors(Archive& archive, ArchiveLayout& layout) {
  const auto entries = archive.entries();
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const std::string_view file = file_part(entries[e].name);
    const std::string stem = without_endings(file);
    if (is_one_of(stem, sensors)) layout[e].sensor = stem;
    if (file != "record.properties") continue;
    if (const std::string phone = phone_in(text_of(archive, e)); !phone.empty())
      note_beside(archive, e, "recorded by " + phone + ", as record.properties says", layout);
  }
}

}  // namespace proofmass::io
