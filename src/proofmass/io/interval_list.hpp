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

/// A stretch of a recording that the user points at.
struct Interval {
  double start = 0.0;       ///< s since the first sample; or that sample's number, from 0
  double end = 0.0;         ///< s, itself outside; or the number of the last sample, itself inside
  bool in_samples = false;  ///< whether start and end are numbers of samples
  std::string label;        ///< empty if it has none
  std::optional<double> angle_rad;          ///< of the table, where the list has one
  std::optional<std::array<double, 3>> up;  ///< unit vector of the force in the fixture's frame
  std::size_t line = 0;                     ///< of the file, 1 = first
};

/// Reads a list of intervals: a table with a header that names `start` and `end` (seconds; also
/// start_s, begin, to, stop, start (ms) …), or `first` and `last` or start_sample and end_sample
/// (numbers of samples, from 0), and perhaps `label`, the table's `angle` (deg unless it says rad)
/// and the true direction of the force, up_x up_y up_z or x_true y_true z_true, of any length; or
/// an Audacity label track, whose rows are start, end and text between tabs, without a header.
/// Compressed files open as they are. In the order of the times. `path` "-" is standard input.
/// Errors: unreadable; corrupt (a row that is no interval, an end before its start, two that
/// overlap, a direction without length), too_few_samples (no row). Each names the file and line.
[[nodiscard]] Result<std::vector<Interval>> read_intervals(const std::string& path);

/// The same for bytes that are in memory already; `name` stands for the file in errors.
[[nodiscard]] Result<std::vector<Interval>> read_intervals(std::span<const std::byte> bytes,
                                                           const std::string& name);

/// Whether every interval lies in a recording of `samples` that lasts `duration_s` from the first
/// to the last; an end may lie one step beyond. Errors: invalid_argument, which names the first
/// that does not, with its line.
[[nodiscard]] Status check_inside(const std::vector<Interval>& intervals,
                                  double duration_s,
                                  std::size_t samples);

}  // namespace proofmass::io
