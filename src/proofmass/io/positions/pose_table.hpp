#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::io {

/// One row of a table of means: the mean of a static accelerometer in one position.
struct PoseRow {
  std::string label;             ///< empty if it has none
  std::array<double, 3> mean{};  ///< x, y, z in `unit`
  Unit unit;                     ///< one for all rows; Quantity::unknown if not stated
  std::optional<std::array<double, 3>> std_of_mean;  ///< in `unit`, if the table has it
  std::optional<std::size_t> samples;                ///< number in the mean, if given
  std::optional<std::array<double, 3>> up;  ///< unit vector of the force in the fixture's frame
  std::optional<double> start_s, end_s;     ///< in the recording of the means
  std::size_t row = 0;                      ///< in the table, 0 = first
};

struct PoseTable {
  std::vector<PoseRow> rows;
  std::vector<Note> notes;  ///< the interpretation of the columns, and unused columns
};

/// True if a recording is a table of means rather than a series of samples: at most a thousand rows
/// with three columns named as means ("x_mean (g)", "mean_x", "acc_x_mean"), or three of true
/// directions ("x_true (g)") besides three measured ones. Decided by names alone: a short recording
/// of three accelerations is not a table of means.
[[nodiscard]] bool looks_like_pose_table(const Recording& recording);

/// True if a recording without an accelerometer has the shape of a table of means: three columns of
/// at most a thousand rows, or three rows.
[[nodiscard]] bool is_plain_pose_table(const Recording& recording);

/// Interprets the columns of a recording as a table of means, one row per position:
///   x_mean (g), mean_x, acc_x_mean, or plain x, ax, acc_x: the means;
///   x_sem, x_std_mean: standard deviation of the mean;
///   x_std, sd_x: of the samples, used over √n only if a column `samples` or `n` gives their
///   number; this is too small if the noise is not white;
///   x_true (g), up_x, true_x: the direction of the force, of any length;
///   start, end (s); a text column, or a number named position, pose or id: the label.
/// Three columns without such names are x, y and z; so are three rows of four columns or more. A
/// row whose three means are not all finite is skipped with a note. `unit` is that of the means,
/// overriding the table.
/// Errors: corrupt (no three columns of means, or with incompatible units; a zero direction),
/// too_few_samples (no row of three means).
[[nodiscard]] Result<PoseTable> pose_table(const Recording& recording,
                                           const std::optional<Unit>& unit = {});

/// The same for a file of any format; `path` "-" is standard input.
/// Errors: also those of read_recording; each names the file.
[[nodiscard]] Result<PoseTable> read_pose_table(const std::string& path,
                                                const std::optional<Unit>& unit = {});

}  // namespace proofmass::io
