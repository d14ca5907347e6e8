#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// What a column of a table of means holds of one axis.
enum class PoseRole { reading, mean, std_of_samples, std_of_mean, direction };

/// A column's name taken apart: "acc1_x_std" is the std_of_samples of axis 0 of "acc1".
struct PoseColumn {
  PoseRole role = PoseRole::reading;
  std::size_t axis = 0;
  std::string sensor;
};

/// nullopt where a name is that of no axis, or of another sensor's ("gyr_x").
[[nodiscard]] std::optional<PoseColumn> read_pose_column(std::string_view name);

/// Three columns that belong together, as indices into Recording::channels.
struct PoseTriple {
  std::string sensor;
  std::array<std::size_t, 3> columns{};
};

/// The first three columns of one role, and of `sensor` where that has them. Readings and means
/// are those of what an accelerometer gives: accelerations, voltages, counts or an unknown unit.
[[nodiscard]] std::optional<PoseTriple> find_triple(const Recording& recording,
                                                    PoseRole role,
                                                    std::string_view sensor = {});

/// The means: columns that are called so, else three plain readings.
[[nodiscard]] std::optional<PoseTriple> find_means(const Recording& recording);

}  // namespace proofmass::io
