#pragma once

#include <array>
#include <cstddef>
#include <iio.h>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/mount_matrix.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Bytes of a scan element: 16 figures of 64 bits.
inline constexpr std::size_t widest_iio_element = 128;

/// One scan element of a device, and what turns its raw figure into `unit`:
/// (raw + offset) · factor. Source: Linux, Documentation/ABI/testing/sysfs-bus-iio.
struct IioColumn {
  iio_channel* channel = nullptr;
  std::string name{};  ///< "accel_x"
  Unit unit{};
  double offset = 0.0, factor = 1.0;
  std::size_t first = 0;    ///< of the recording's channels
  std::size_t figures = 1;  ///< of a quaternion 4, each a channel of its own
};

/// Three axes that a mount matrix turns, as indices of the recording's channels.
struct IioTurn {
  std::array<std::size_t, 3> axes{};
  MountMatrix board_from_chip{};
};

/// What of a device is read, and how.
struct IioColumns {
  std::vector<IioColumn> columns;
  std::vector<IioTurn> turns;
  iio_channel* stamp = nullptr;  ///< of each row; nullptr if the device has none
  std::vector<Channel> heads;    ///< the recording's channels, without values
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Note> notes;
};

/// The device whose name, label or id is `wanted`; where that is empty, the only one that measures
/// acceleration. Errors: invalid_argument, with those there are.
[[nodiscard]] Result<iio_device*> choose_device(const iio_context* context,
                                                const std::string& wanted);

/// The scan elements of these names, all if there are none, and the device's timestamps.
/// Errors: invalid_argument (a name that the device has not), unsupported (a layout that is not
/// read).
[[nodiscard]] Result<IioColumns> choose_columns(iio_device* device,
                                                const std::vector<std::string>& wanted);

/// Makes these the channels that a buffer of the device carries.
void enable(const iio_device* device, const IioColumns& columns);

/// Rows as libiio has them in its buffer, into an arrival that is empty. Bytes behind the last
/// whole row are left, and told. Errors: device (the buffer lacks a channel that was enabled).
[[nodiscard]] Status decode(const iio_buffer* buffer, const IioColumns& columns, Arrival& arrival);

}  // namespace proofmass::acquire
