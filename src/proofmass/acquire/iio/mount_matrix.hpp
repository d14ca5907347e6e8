#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Orientation of a chip on its board: board = matrix · chip. Row by row. Source: Linux,
/// Documentation/ABI/testing/sysfs-bus-iio, in_accel_mount_matrix.
using MountMatrix = std::array<double, 9>;

/// "0, 1, 0; -1, 0, 0; 0, 0, 1". nullopt for the identity.
/// Errors: corrupt (not nine numbers, or neither a rotation nor a reflection: its rows are not
/// orthonormal).
[[nodiscard]] Result<std::optional<MountMatrix>> parse_mount_matrix(std::string_view text);

/// Rotates the samples of three axes in place.
void turn(const MountMatrix& board_from_chip,
          std::vector<double>& x,
          std::vector<double>& y,
          std::vector<double>& z);

}  // namespace proofmass::acquire
