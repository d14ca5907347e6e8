#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// Role of a column in a table of means, for one axis.
enum class PoseRole { reading, mean, std_of_samples, std_of_mean, direction };

/// A parsed column name: "acc1_x_std" is the std_of_samples of axis 0 of "acc1".
struct PoseColumn {
  PoseRole role = PoseRole::reading;
  std::size_t axis = 0;
  std::string sensor;
};

/// nullopt if the name has no axis, or belongs to another sensor ("gyr_x").
[[nodiscard]] std::optional<PoseColumn> read_pose_column(std::string_view name);

/// Three matching columns, as indices into Recording::channels.
struct PoseTriple {
  std::string sensor;
  std::array<std::size_t, 3> columns{};
};

/// The first three columns of one role, of `sensor` if it has them. Readings and means are
/// accelerometer outputs: accelerations, voltages, counts or an unknown unit.
[[nodiscard]] std::optional<PoseTriple> find_triple(const Recording& recording,
                                                    PoseRole role,
                                                    std::string_view sensor = {});

/// The means: columns named as such, else three plain readings.
[[nodiscard]] std::optional<PoseTriple> find_means(const Recording& recording);

}  // namespace proofmass::io
