#pragma once

#include <array>
#include <cstddef>
#include <iio.h>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/iio/mount_matrix.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Size of a scan element: 16 values of 64 bits.
inline constexpr std::size_t widest_iio_element = 128;

/// One scan element of a device, and the conversion of its raw value to `unit`: (raw + offset) ·
/// factor. Source: Linux, Documentation/ABI/testing/sysfs-bus-iio.
struct IioColumn {
  iio_channel* channel = nullptr;
  std::string name{};  ///< "accel_x"
  Unit unit{};
  double offset = 0.0, factor = 1.0;
  std::size_t first = 0;    ///< index in the recording's channels
  std::size_t figures = 1;  ///< 4 for a quaternion, each a separate channel
};

/// Three axes rotated by a mount matrix, as indices of the recording's channels.
struct IioTurn {
  std::array<std::size_t, 3> axes{};
  MountMatrix board_from_chip{};
};

/// The columns read from a device.
struct IioColumns {
  std::vector<IioColumn> columns;
  std::vector<IioTurn> turns;
  iio_channel* stamp = nullptr;  ///< timestamp of each row; nullptr if the device has none
  std::vector<Channel> heads;    ///< the recording's channels, without values
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<Note> notes;
};

/// The device whose name, label or id is `wanted`; if that is empty, the only one that measures
/// acceleration. Errors: invalid_argument, with the available devices.
[[nodiscard]] Result<iio_device*> choose_device(const iio_context* context,
                                                const std::string& wanted);

/// The scan elements with these names, all if none are given, and the device's timestamps. Errors:
/// invalid_argument (an unknown name), unsupported (an unsupported layout).
[[nodiscard]] Result<IioColumns> choose_columns(iio_device* device,
                                                const std::vector<std::string>& wanted);

/// Enables exactly these channels in the device's buffer.
void enable(const iio_device* device, const IioColumns& columns);

/// Decodes the rows of libiio's buffer into an empty arrival. Bytes after the last whole row are
/// dropped, with a note. Errors: device (an enabled channel is missing in the buffer).
[[nodiscard]] Status decode(const iio_buffer* buffer, const IioColumns& columns, Arrival& arrival);

}  // namespace proofmass::acquire
