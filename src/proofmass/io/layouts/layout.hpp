#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/archive/archive.hpp"

namespace proofmass::io {

/// Information of a folder or zip archive on one of its files, beyond its contents.
struct MemberHint {
  bool is_recording = true;       ///< false: it describes the others
  std::optional<double> rate_hz;  ///< if the file has no time
  /// Time since 1970 at which the file's stamps, in seconds, are zero.
  std::optional<std::int64_t> zero_ns;
  std::string sensor;    ///< prefix for names that are an axis alone: "Gyroscope"; may be empty
  std::string unit;      ///< unit of columns named by an axis alone, if the file has none
  std::string left_out;  ///< a counter column of omitted data, not a time
  std::vector<Note> notes;
};

/// Information on an archive's files, by their index among its entries.
using ArchiveLayout = std::map<std::size_t, MemberHint>;

/// The beginning of a small text, at most 64 KiB; empty if it cannot be read.
[[nodiscard]] std::string text_of(Archive& archive, std::size_t entry);
/// A field of a text table without separators and quotes; empty beyond the last.
[[nodiscard]] std::string field_of(std::string_view line, char separator, std::size_t column);
/// The lines of a text, without their ends.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

/// Metadata in the exports of these programs. Each function adds to the layout if an archive is
/// such an export, or contains one. To add a program, add a file and a line in layouts/tables.cpp.

/// phyphox: meta/time.csv (time of day of the experiment), meta/device.csv. Source: phyphox wiki,
/// "Export"; the files of its version 1.1.
void read_phyphox_layout(Archive& archive, ArchiveLayout& layout);
/// x-io's x-IMU: NAME_CalInertialAndMag.csv and similar files have packet numbers instead of times;
/// the rate is in NAME_Registers.csv, or follows from the packets of NAME_DateTime.csv. Source:
/// x-io Technologies, x-IMU User Manual 5.2, "Data rates" (2^(value - 1) Hz).
namespace ximu {
void read_layout(Archive& archive, ArchiveLayout& layout);
}
/// Sensor Logger: columns x, y, z without units in files named after their sensor. Source: K. T. H.
/// Choi, "One-Page Unit Reference" of Sensor Logger.
void read_sensor_logger_layout(Archive& archive, ArchiveLayout& layout);
/// All others: files named accelerometer, gyroscope, … whose columns are named by their axes; the
/// phone named in record.properties.
void read_named_sensors(Archive& archive, ArchiveLayout& layout);

}  // namespace proofmass::io
