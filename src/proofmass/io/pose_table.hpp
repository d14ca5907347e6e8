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

/// One row of a table of means: what an accelerometer read at rest in one position.
struct PoseRow {
  std::string label;             ///< empty if it has none
  std::array<double, 3> mean{};  ///< x, y, z in `unit`
  Unit unit;                     ///< one for all rows; Quantity::unknown where nothing says
  std::optional<std::array<double, 3>> std_of_mean;  ///< in `unit`, where the table tells
  std::optional<std::size_t> samples;                ///< behind the mean, where the table tells
  std::optional<std::array<double, 3>> up;  ///< unit vector of the force in the fixture's frame
  std::optional<double> start_s, end_s;     ///< in the recording that the means are of
  std::size_t row = 0;                      ///< of the table, 0 = first
};

struct PoseTable {
  std::vector<PoseRow> rows;
  std::vector<Note> notes;  ///< which columns were taken for what, and what was not used
};

/// Whether a recording is a table of means rather than a series of samples: at most a thousand rows
/// with three columns that are called means ("x_mean (g)", "mean_x", "acc_x_mean"), or three of
/// true directions ("x_true (g)") beside three readings. By names alone: a short recording of three
/// accelerations is never taken for one.
[[nodiscard]] bool looks_like_pose_table(const Recording& recording);

/// Whether a recording in which no accelerometer is found has the shape of a table of means: three
/// columns of at most a thousand rows, or three rows.
[[nodiscard]] bool is_plain_pose_table(const Recording& recording);

/// Takes the columns of a recording for a table of means, one row a position:
///   x_mean (g), mean_x, acc_x_mean, or plain x, ax, acc_x: the means;
///   x_sem, x_std_mean: standard deviation of the mean;
///   x_std, sd_x: of the samples, used over √n only where a column `samples` or `n` tells their
///   number, which says too little where the noise is not white;
///   x_true (g), up_x, true_x: the direction of the force, of any length;
///   start, end (s); a column of words, or a number called position, pose or id: the label.
/// Three columns without such names are x, y and z; so are three rows of four columns or more.
/// A row whose three means are not all finite is left out with a note. `unit` is the means',
/// whatever the table says.
/// Errors: corrupt (no three columns of means, or of units that do not go together; a direction of
/// no length), too_few_samples (no row of three means).
[[nodiscard]] Result<PoseTable> pose_table(const Recording& recording,
                                           const std::optional<Unit>& unit = {});

/// The same for a file of any format; `path` "-" is standard input.
/// Errors: also those of read_recording; each names the file.
[[nodiscard]] Result<PoseTable> read_pose_table(const std::string& path,
                                                const std::optional<Unit>& unit = {});

}  // namespace proofmass::io
