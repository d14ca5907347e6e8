#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// An interval of a recording selected by the user.
struct Interval {
  double start = 0.0;               ///< s from the first sample; or a sample number, from 0
  double end = 0.0;                 ///< s, exclusive; or the number of the last sample, inclusive
  bool in_samples = false;          ///< whether start and end are sample numbers
  std::string label;                ///< empty if it has none
  std::optional<double> angle_rad;  ///< angle of the table, if the list has one
  std::optional<std::array<double, 3>> up;  ///< unit vector of the force in the fixture's frame
  std::size_t line = 0;                     ///< in the file, 1 = first
};

/// Reads a list of intervals: a table with the columns
///
/// - `start` and `end` (seconds; also start_s, begin, to, stop, start (ms) …), or `first` and
///   `last` or start_sample and end_sample (sample numbers, from 0),
/// - optionally `label`, the table's `angle` (deg by default, or rad) and the true direction of the
///   force, up_x up_y up_z or x_true y_true z_true, of any length;
///
/// or an Audacity label track, whose rows are start, end and text separated by tabs, without a
/// header. Compressed files are supported. The result is sorted by time. `path` "-" is standard
/// input.
/// Errors: unreadable; corrupt (a row that is not an interval, an end before its start, overlapping
/// intervals, a zero direction), too_few_samples (no row). Each names the file and line.
[[nodiscard]] Result<std::vector<Interval>> read_intervals(const std::string& path);

/// The same for bytes in memory; `name` is the file name in errors.
[[nodiscard]] Result<std::vector<Interval>> read_intervals(std::span<const std::byte> bytes,
                                                           const std::string& name);

/// Checks that every interval lies in a recording of `samples` that lasts `duration_s` from the
/// first to the last; an end may be one step beyond. Errors: invalid_argument, for the first that
/// does not, with its line.
[[nodiscard]] Status check_inside(const std::vector<Interval>& intervals,
                                  double duration_s,
                                  std::size_t samples);

}  // namespace proofmass::io
