#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/archive.hpp"

namespace proofmass::io {

/// What a folder or zip archive says of one of its files beside what stands in it.
struct MemberHint {
  bool is_recording = true;       ///< false: it says something of the others
  std::optional<double> rate_hz;  ///< where the file has no time
  /// Time at which the file's stamps, which are in seconds, are zero, on the clock of 1970.
  std::optional<std::int64_t> zero_ns;
  std::string sensor;    ///< put before names that are an axis alone: "Gyroscope"; may be empty
  std::string unit;      ///< of columns called by an axis alone, if none stands in the file
  std::string left_out;  ///< column that counts what is not in the file, and is no time
  std::vector<Note> notes;
};

/// What is known of an archive's files, by their place among its entries.
using ArchiveLayout = std::map<std::size_t, MemberHint>;

/// The beginning of a small text, 64 KiB at most; empty if it cannot be read.
[[nodiscard]] std::string text_of(Archive& archive, std::size_t entry);
/// A field of a table of text as it stands between separators and quotes; empty beyond the last.
[[nodiscard]] std::string field_of(std::string_view line, char separator, std::size_t column);
/// The lines of a text, without their ends.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

/// What these programs' exports say beside their recordings; adds to the layout where an archive
/// is one, or holds some. A program is added by a file and a line in archive_tables.cpp.

/// phyphox: meta/time.csv (when the experiment ran, by the wall clock), meta/device.csv.
/// Source: phyphox wiki, "Export"; the files of its version 1.1.
void read_phyphox_layout(Archive& archive, ArchiveLayout& layout);
/// x-io's x-IMU: NAME_CalInertialAndMag.csv and its fellows have packet numbers for a time; the
/// rate stands in NAME_Registers.csv, or is counted between the packets of NAME_DateTime.csv.
/// Source: x-io Technologies, x-IMU User Manual 5.2, "Data rates" (2^(value - 1) Hz).
void read_ximu_layout(Archive& archive, ArchiveLayout& layout);
/// Sensor Logger: columns x, y, z without units in files called by their sensor.
/// Source: K. T. H. Choi, "One-Page Unit Reference" of Sensor Logger.
void read_sensor_logger_layout(Archive& archive, ArchiveLayout& layout);
/// Any other: files called accelerometer, gyroscope, … whose columns are called by their axes; the
/// phone that record.properties names.
void read_named_sensors(Archive& archive, ArchiveLayout& layout);

}  // namespace proofmass::io
