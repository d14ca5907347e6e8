#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A time in a recording with information from the user.
struct Instant {
  double time_s = 0.0;               ///< since the recording's first sample
  std::optional<double> position_m;  ///< position of the sensor
  std::optional<double> std_m;       ///< its standard deviation, above 0
  std::size_t line = 0;              ///< in the file, 1 = first
};

/// Reads a list of times: a table with the columns
///
/// - `time` (also t, time_s, "t (ms)"; s by default),
/// - optionally `position` (also x, displacement, distance, height; m by default, or cm, mm, …),
/// - optionally `std` (also sd, sigma, uncertainty; by default in the unit of the position);
///
/// or without a header one to three columns in that order, in s and m. Compressed files are
/// supported. The result is sorted by time. `path` "-" is standard input.
/// Errors: unreadable; corrupt (no time column, a field that is not a number, a std not above 0,
/// two rows with the same time), too_few_samples (no row). Each names the file and line.
[[nodiscard]] Result<std::vector<Instant>> read_instants(const std::string& path);

/// The same for bytes in memory; `name` is the file name in errors.
[[nodiscard]] Result<std::vector<Instant>> read_instants(std::span<const std::byte> bytes,
                                                         const std::string& name);

/// Checks that every time lies in a recording that lasts `duration_s` from the first sample to the
/// last. Errors: invalid_argument, for the first that does not, with its line.
[[nodiscard]] Status check_inside(const std::vector<Instant>& instants, double duration_s);

/// Drops the times outside a recording that lasts `duration_s` and returns their number.
std::size_t drop_outside(std::vector<Instant>& instants, double duration_s);

}  // namespace proofmass::io
