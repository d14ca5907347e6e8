#include "proofmass/io/tdms/column.hpp"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <limits>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::tdms {
namespace {

/// Values read together of a channel that is not adjacent to the others.
constexpr std::uint64_t values_at_once = 16 << 10;

}  // namespace

Status Window::read(std::uint64_t offset, std::span<char> into) const {
  const auto count = file_.read_at(offset, into);
  if (!count) return count.error();
  if (*count == into.size()) return Done{};
  return Error{Errc::corrupt, fmt::format("byte {}: the file has become shorter while it was read",
                                          offset + *count)};
}

Result<const char*> Window::view(std::uint64_t offset, std::size_t size) {
  PM_EXPECTS(size <= bytes);
  if (offset < held_at_ || offset + size > held_at_ + held_size_) {
    const std::uint64_t there = file_.size() - std::min(file_.size(), offset);
    held_.resize(static_cast<std::size_t>(std::min(bytes, file_.size())));
    held_at_ = offset;
    held_size_ = static_cast<std::size_t>(std::min<std::uint64_t>(held_.size(), there));
    held_size_ = std::max(held_size_, std::min(size, held_.size()));
    const Status filled = read(offset, std::span(held_).first(held_size_));
    if (!filled) {
      held_size_ = 0;
      return filled.error();
    }
    PM_EXPECTS(held_size_ >= size);
  }
  return held_.data() + (offset - held_at_);
}

Column::Column(const Map& map, std::uint32_t channel, std::uint32_t scaler)
    : map_(map), channel_(channel), scaler_(scaler) {
  find_run();
}

/// Advances from the current run to the first with values of this channel.
void Column::find_run() {
  for (entry_ = nullptr; run_ < map_.runs.size(); ++run_) {
    const Layout& layout = map_.layouts[map_.runs[run_].layout];
    for (const Entry& entry : layout.of(channel_)) {
      if (entry.scaler != scaler_ || entry.pieces == 0 || entry.values == 0) continue;
      entry_ = &entry;
      encoding_.kind = entry.kind;
      encoding_.bit = entry.bit;
      encoding_.big_endian = layout.big_endian;
      find_extent();
      return;
    }
  }
}

void Column::find_extent() {
  const Run& run = map_.runs[run_];
  const Layout& layout = map_.layouts[run.layout];
  const std::uint64_t a_segment = entry_->values * run.chunks;
  const std::uint64_t segment = done_ / a_segment;
  const std::uint64_t chunk = done_ % a_segment / entry_->values;
  std::uint64_t value = done_ % entry_->values;
  const Piece* piece = &layout.pieces[entry_->first_piece];
  for (; value >= piece->values; ++piece) value -= piece->values;

  extent_.offset = run.data_at + segment * run.distance + chunk * layout.chunk_bytes +
                   piece->offset + value * piece->stride;
  extent_.stride = piece->stride;
  extent_.values = piece->values - value;
  const bool is_one = piece->values == 1 && entry_->values == 1;
  if (is_one && run.chunks == 1) {
    if (run.segments > 1) extent_.stride = run.distance;
    extent_.values = run.segments - segment;
  } else if (is_one) {
    extent_.stride = layout.chunk_bytes;
    extent_.values = run.chunks - chunk;
  } else if (entry_->pieces == 1 && piece->stride * entry_->values == layout.chunk_bytes) {
    extent_.values += entry_->values * (run.chunks - chunk - 1);
  }

  const std::uint64_t size = bytes_per_value(entry_->kind);
  const bool is_alone = run.chunks == 1 && run.segments > 1;
  const std::uint64_t period = is_alone ? run.distance : layout.chunk_bytes;
  constexpr std::uint64_t near = Window::bytes / 4;
  if (extent_.stride > size) {
    extent_.is_shared = extent_.stride <= near;
    extent_.bytes_a_value = extent_.stride;
    extent_.reach = extent_.stride;
  } else {
    extent_.is_shared = period <= near;
    extent_.bytes_a_value = std::max(size, period / entry_->values);
    extent_.reach = period;
  }
}

std::size_t Column::comfortable() const {
  if (entry_ == nullptr || !extent_.is_shared) return values_at_once;
  const std::uint64_t room = (Window::bytes - extent_.reach) / extent_.bytes_a_value;
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(room, 1, values_at_once));
}

void Column::advance(std::uint64_t count) {
  const Run& run = map_.runs[run_];
  done_ += count;
  extent_.values -= count;
  extent_.offset += count * extent_.stride;
  if (extent_.values > 0) return;
  if (done_ < entry_->values * run.chunks * run.segments) {
    find_extent();
    return;
  }
  ++run_;
  done_ = 0;
  find_run();
}

/// Reads values of the current extent.
Status Column::take(Window& window, std::span<double> into) {
  const std::size_t size = bytes_per_value(entry_->kind);
  const auto stride = static_cast<std::size_t>(extent_.stride);
  const std::size_t wanted = (into.size() - 1) * stride + size;
  const bool is_native = encoding_.big_endian == (std::endian::native == std::endian::big);
  if (extent_.is_shared) {
    const auto bytes = window.view(extent_.offset, wanted);
    if (!bytes) return bytes.error();
    decode(*bytes, stride, encoding_, into);
  } else if (encoding_.kind == Kind::f64 && is_native && stride == size) {
    return window.read(extent_.offset, {reinterpret_cast<char*>(into.data()), into.size_bytes()});
  } else {
    own_.resize(std::max(own_.size(), wanted));
    const Status read = window.read(extent_.offset, std::span(own_).first(wanted));
    if (!read) return read;
    decode(own_.data(), stride, encoding_, into);
  }
  return Done{};
}

Status Column::read(Window& window, std::span<double> into) {
  while (!into.empty() && entry_ != nullptr) {
    std::uint64_t most = values_at_once;
    if (extent_.stride > bytes_per_value(entry_->kind) || extent_.is_shared)
      most = std::max<std::uint64_t>(
          1, (Window::bytes - bytes_per_value(entry_->kind)) / extent_.stride);
    const auto count =
        static_cast<std::size_t>(std::min({most, extent_.values, std::uint64_t{into.size()}}));
    const Status taken = take(window, into.first(count));
    if (!taken) return taken;
    into = into.subspan(count);
    advance(count);
  }
  std::ranges::fill(into, std::numeric_limits<double>::quiet_NaN());
  return Done{};
}

Result<std::optional<Instant>> Column::first_instant(Window& window) const {
  using Found = std::optional<Instant>;
  Column ahead(map_, channel_, scaler_);
  constexpr int most_looked_at = 1000;
  for (int i = 0; i < most_looked_at && ahead.entry_ != nullptr; ++i) {
    const auto bytes = window.view(ahead.extent_.offset, bytes_per_value(Kind::instant));
    if (!bytes) return bytes.error();
    const Instant instant = load_instant(*bytes, ahead.encoding_.big_endian);
    if (instant.is_set()) return Found(instant);
    ahead.advance(1);
  }
  return Found{};
}

}  // namespace proofmass::io::tdms
