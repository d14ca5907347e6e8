#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/acquire/iio/columns.hpp"

// Converts the contents of libiio's buffer to numbers.
namespace proofmass::acquire {
namespace {

template <class Figure>
double figure_at(const std::byte* bytes) {
  Figure figure{};
  std::memcpy(&figure, bytes, sizeof figure);
  return static_cast<double>(figure);
}

using ReadFigure = double (*)(const std::byte*);

ReadFigure figure_reader(const iio_data_format& format) {
  switch (format.length) {
    case 8:
      return format.is_signed ? figure_at<std::int8_t> : figure_at<std::uint8_t>;
    case 16:
      return format.is_signed ? figure_at<std::int16_t> : figure_at<std::uint16_t>;
    case 32:
      return format.is_signed ? figure_at<std::int32_t> : figure_at<std::uint32_t>;
    default:
      return format.is_signed ? figure_at<std::int64_t> : figure_at<std::uint64_t>;
  }
}

struct RawRows {
  const iio_buffer* buffer;
  std::size_t rows;
  std::ptrdiff_t step;
};

// The first row's element of a channel; nullptr if the last row's would end beyond the buffer, as
// happens if the channel was omitted when the buffer was filled.
const std::byte* first_of(const RawRows& raw, const iio_channel* channel) {
  const auto* const first = static_cast<const std::byte*>(iio_buffer_first(raw.buffer, channel));
  const auto* const end = static_cast<const std::byte*>(iio_buffer_end(raw.buffer));
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  const auto bytes = std::ptrdiff_t{format.length} / 8 * std::max(format.repeat, 1U);
  const auto last = static_cast<std::ptrdiff_t>(raw.rows - 1) * raw.step;
  return end - first >= last + bytes ? first : nullptr;
}

void decode_column(const RawRows& raw,
                   const IioColumn& column,
                   const std::byte* at,
                   Arrival& arrival) {
  const iio_data_format& format = *iio_channel_get_data_format(column.channel);
  const ReadFigure figure = figure_reader(format);
  const std::size_t bytes = format.length / 8;
  alignas(8) std::array<std::byte, widest_iio_element> host{};
  for (std::size_t row = 0; row < raw.rows; ++row, at += raw.step) {
    // Byte order, shift and sign.
    iio_channel_convert(column.channel, host.data(), at);
    for (std::size_t k = 0; k < column.figures; ++k)
      arrival.channels[column.first + k].push_back(
          (figure(host.data() + k * bytes) + column.offset) * column.factor);
  }
}

void decode_stamps(const RawRows& raw,
                   const iio_channel* stamp,
                   const std::byte* at,
                   Arrival& arrival) {
  for (std::size_t row = 0; row < raw.rows; ++row, at += raw.step) {
    std::int64_t time_ns = 0;
    iio_channel_convert(stamp, &time_ns, at);
    arrival.device_ns.push_back(time_ns);
  }
}

Error missing(std::string_view channel) {
  return {Errc::device,
          fmt::format("the device's buffer does not carry {}, which was enabled; leave it out with "
                      "channels=",
                      channel)};
}

}  // namespace

void enable(const iio_device* device, const IioColumns& columns) {
  for (unsigned k = 0; k < iio_device_get_channels_count(device); ++k)
    iio_channel_disable(iio_device_get_channel(device, k));
  for (const IioColumn& column : columns.columns) iio_channel_enable(column.channel);
  if (columns.stamp != nullptr) iio_channel_enable(columns.stamp);
}

Status decode(const iio_buffer* buffer, const IioColumns& columns, Arrival& arrival) {
  const std::ptrdiff_t size = static_cast<const std::byte*>(iio_buffer_end(buffer)) -
                              static_cast<const std::byte*>(iio_buffer_start(buffer));
  const std::ptrdiff_t step = iio_buffer_step(buffer);
  if (step <= 0 || size < step) return Done{};
  const RawRows raw{buffer, static_cast<std::size_t>(size / step), step};
  if (size % step != 0)
    arrival.notes.push_back(
        {Severity::warning,
         fmt::format("a buffer of the device ended within a row: {} bytes of {} are left out",
                     size % step, step)});
  for (const IioColumn& column : columns.columns) {
    const std::byte* const at = first_of(raw, column.channel);
    if (at == nullptr) return missing(column.name);
    decode_column(raw, column, at, arrival);
  }
  if (columns.stamp != nullptr) {
    const std::byte* const at = first_of(raw, columns.stamp);
    if (at == nullptr) return missing("timestamp");
    decode_stamps(raw, columns.stamp, at, arrival);
  }
  for (const IioTurn& t : columns.turns)
    turn(t.board_from_chip, arrival.channels[t.axes[0]], arrival.channels[t.axes[1]],
         arrival.channels[t.axes[2]]);
  return Done{};
}

}  // namespace proofmass::acquire
