#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// An instant of a recording of which the user knows something.
struct Instant {
  double time_s = 0.0;               ///< since the recording's first sample
  std::optional<double> position_m;  ///< where the sensor was
  std::optional<double> std_m;       ///< how well that is known, above 0
  std::size_t line = 0;              ///< of the file, 1 = first
};

/// Reads a list of instants: a table with a header that names `time` (also t, time_s, "t (ms)"; s
/// unless it says otherwise) and perhaps `position` (also x, displacement, distance, height; m,
/// unless it says cm, mm, …) and `std` (also sd, sigma, uncertainty; in the unit of the position
/// unless it says its own); or without a header one to three columns in that order, in s and m.
/// Compressed files open as they are. In the order of the times. `path` "-" is standard input.
/// Errors: unreadable; corrupt (no column of times, a field that is no number, a std not above 0,
/// two rows of one time), too_few_samples (no row). Each names the file and line.
[[nodiscard]] Result<std::vector<Instant>> read_instants(const std::string& path);

/// The same for bytes that are in memory already; `name` stands for the file in errors.
[[nodiscard]] Result<std::vector<Instant>> read_instants(std::span<const std::byte> bytes,
                                                         const std::string& name);

/// Whether every instant lies in a recording that lasts `duration_s` from the first sample to the
/// last. Errors: invalid_argument, which names the first that does not, with its line.
[[nodiscard]] Status check_inside(const std::vector<Instant>& instants, double duration_s);

}  // namespace proofmass::io
