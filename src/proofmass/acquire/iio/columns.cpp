#include "proofmass/acquire/iio/columns.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>

#include "proofmass/acquire/iio/handle.hpp"

namespace proofmass::acquire {
namespace {

bool is_read(const iio_channel* channel) {
  return iio_channel_is_scan_element(channel) && !iio_channel_is_output(channel);
}

std::vector<iio_channel*> elements(const iio_device* device) {
  std::vector<iio_channel*> out;
  for (unsigned k = 0; k < iio_device_get_channels_count(device); ++k) {
    iio_channel* const channel = iio_device_get_channel(device, k);
    if (is_read(channel) && iio_channel_get_type(channel) != IIO_TIMESTAMP) out.push_back(channel);
  }
  return out;
}

bool measures_acceleration(const iio_device* device) {
  return std::ranges::any_of(elements(device), [](const iio_channel* channel) {
    return iio_channel_get_type(channel) == IIO_ACCEL;
  });
}

struct IioUnit {
  std::string_view symbol;
  double factor;  // from the kernel's unit
};

// The kernel's units are those of its ABI: millivolts, thousandths of a degree Celsius.
IioUnit unit_of(iio_chan_type type) {
  switch (type) {
    case IIO_ACCEL:
    case IIO_GRAVITY:
      return {"m/s^2", 1.0};
    case IIO_ANGL_VEL:
      return {"rad/s", 1.0};
    case IIO_VOLTAGE:
    case IIO_ALTVOLTAGE:
      return {"V", 1e-3};
    case IIO_TEMP:
      return {"degC", 1e-3};
    case IIO_MAGN:
      return {"G", 1.0};
    case IIO_PRESSURE:
      return {"kPa", 1.0};
    case IIO_INCLI:
      return {"deg", 1.0};
    case IIO_ANGL:
      return {"rad", 1.0};
    case IIO_DISTANCE:
      return {"m", 1.0};
    case IIO_VELOCITY:
      return {"m/s", 1.0};
    default:
      return {"", 1.0};
  }
}

Result<IioColumn> column_of(iio_channel* channel) {
  const std::string name = iio_channel_get_id(channel);
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  const std::size_t bytes = std::size_t{format.length} / 8 * std::max(format.repeat, 1U);
  const bool whole =
      format.length == 8 || format.length == 16 || format.length == 32 || format.length == 64;
  if (!whole || bytes > widest_iio_element || format.shift >= format.length)
    return Error{Errc::unsupported,
                 fmt::format("channel {}: {} times {} bits, shifted by {}: expected 8, 16, 32 or "
                             "64 bits, {} bytes at most; leave it out with channels=",
                             name, format.repeat, format.length, format.shift, widest_iio_element)};
  IioColumn column{channel, name};
  column.figures = std::max(format.repeat, 1U);
  double scale = 0.0;
  if (iio_channel_attr_read_double(channel, "scale", &scale) < 0) {
    column.unit = parse_unit("counts").value_or(Unit{});
    return column;
  }
  const IioUnit unit = unit_of(iio_channel_get_type(channel));
  column.unit = parse_unit(unit.symbol).value_or(Unit{});
  column.factor = scale * unit.factor;
  double offset = 0.0;
  if (iio_channel_attr_read_double(channel, "offset", &offset) >= 0) column.offset = offset;
  return column;
}

// Attribute of the axis, of all axes, or of the device; libiio treats in_mount_matrix as a channel
// "mount".
std::optional<std::string> mount_text(const iio_device* device, const iio_channel* axis) {
  if (auto text = iio_text(axis, "mount_matrix")) return text;
  if (auto text = iio_text(device, "mount_matrix")) return text;
  const iio_channel* const all = iio_device_find_channel(device, "mount", false);
  return all == nullptr ? std::nullopt : iio_text(all, "matrix");
}

// A sensor's axes have the same name except for the modifier: accel_x, accel_y, accel_z.
void add_turn(const iio_device* device, const IioColumn& x, IioColumns& out) {
  const auto text = mount_text(device, x.channel);
  if (!text) return;
  const std::string stem = x.name.substr(0, x.name.size() - 1);
  const auto matrix = parse_mount_matrix(*text);
  if (!matrix) {
    out.notes.push_back({Severity::warning, stem + "*: " + matrix.error().message + "; left out"});
    return;
  }
  IioTurn turn;
  std::size_t found = 0;
  for (const IioColumn& column : out.columns)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (column.name == stem + "xyz"[axis]) {
        turn.axes[axis] = column.first;
        ++found;
      }
  const bool is_turned = *matrix && found == 3;
  out.settings.emplace_back("mount matrix of " + stem + "*",
                            *text + (*matrix && !is_turned ? " (left out)" : ""));
  if (*matrix && !is_turned)
    out.notes.push_back(
        {Severity::warning, fmt::format("{}*: the board's mount matrix is left out: it needs x, y "
                                        "and z; axes are the chip's",
                                        stem)});
  if (!is_turned) return;
  turn.board_from_chip = **matrix;
  out.turns.push_back(turn);
}

void lay_out(const iio_device* device, IioColumns& out) {
  for (IioColumn& column : out.columns) {
    column.first = out.heads.size();
    for (std::size_t k = 0; k < column.figures; ++k)
      out.heads.push_back({column.figures == 1 ? column.name : fmt::format("{}_{}", column.name, k),
                           column.unit,
                           {}});
  }
  for (const IioColumn& column : out.columns) {
    const std::string& stem = column.name;
    const bool is_first = std::ranges::none_of(out.columns, [&](const IioColumn& other) {
      return other.first < column.first && other.name.size() == stem.size() &&
             std::string_view(other.name).substr(0, stem.size() - 1) ==
                 std::string_view(stem).substr(0, stem.size() - 1);
    });
    const iio_modifier axis = iio_channel_get_modifier(column.channel);
    if (is_first && (axis == IIO_MOD_X || axis == IIO_MOD_Y || axis == IIO_MOD_Z))
      add_turn(device, column, out);
  }
}

}  // namespace

Result<iio_device*> choose_device(const iio_context* context, const std::string& wanted) {
  const std::vector<iio_device*> all = iio_devices(context, false);
  if (!wanted.empty()) {
    iio_device* const device = iio_context_find_device(context, wanted.c_str());
    if (device != nullptr && !iio_device_is_trigger(device)) return device;
    return Error{Errc::invalid_argument,
                 fmt::format("device={}: no such device; there are: {}", wanted, list_of(all))};
  }
  std::vector<iio_device*> fitting;
  std::ranges::copy_if(all, std::back_inserter(fitting), measures_acceleration);
  if (fitting.size() == 1) return fitting.front();
  if (fitting.empty())
    return Error{Errc::invalid_argument,
                 fmt::format("no device has acceleration channels and a buffer; name the one to "
                             "read with device=NAME; there are: {}",
                             list_of(all))};
  return Error{Errc::invalid_argument,
               fmt::format("several devices measure acceleration: {}; name one with device=NAME",
                           list_of(fitting))};
}

Result<IioColumns> choose_columns(iio_device* device, const std::vector<std::string>& wanted) {
  const std::vector<iio_channel*> all = elements(device);
  std::vector<std::string> names;
  for (const iio_channel* const channel : all) names.emplace_back(iio_channel_get_id(channel));
  for (const std::string& name : wanted)
    if (std::ranges::find(names, name) == names.end())
      return Error{Errc::invalid_argument, fmt::format("channels={}: {} has {}", name,
                                                       iio_name(device), fmt::join(names, ", "))};
  if (all.empty())
    return Error{Errc::device, fmt::format("{} has no buffer: its driver gives single values "
                                           "only, which cannot be recorded at a rate",
                                           iio_name(device))};
  IioColumns out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!wanted.empty() && std::ranges::find(wanted, names[k]) == wanted.end()) continue;
    auto column = column_of(all[k]);
    if (!column) return column.error();
    out.columns.push_back(std::move(column).value());
  }
  iio_channel* const stamp = iio_device_find_channel(device, "timestamp", false);
  if (stamp != nullptr && is_read(stamp) && iio_channel_get_data_format(stamp)->length == 64)
    out.stamp = stamp;
  lay_out(device, out);
  return out;
}

}  // namespace proofmass::acquire
