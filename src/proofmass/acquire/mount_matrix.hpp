#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// How a chip is mounted on its board: board = matrix · chip. Row after row.
/// Source: Linux, Documentation/ABI/testing/sysfs-bus-iio, in_accel_mount_matrix.
using MountMatrix = std::array<double, 9>;

/// "0, 1, 0; -1, 0, 0; 0, 0, 1". nullopt for the identity, which changes nothing.
/// Errors: corrupt (not nine numbers, or no rotation or mirroring: its rows are not orthonormal).
[[nodiscard]] Result<std::optional<MountMatrix>> parse_mount_matrix(std::string_view text);

/// Turns the samples of three axes where they are.
void turn(const MountMatrix& board_from_chip,
          std::vector<double>& x,
          std::vector<double>& y,
          std::vector<double>& z);

}  // namespace proofmass::acquire
