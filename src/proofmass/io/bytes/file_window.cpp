#include "proofmass/io/bytes/file_window.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace proofmass::io {

Result<std::string_view> FileWindow::view(std::uint64_t offset, std::uint64_t count) {
  if (offset >= end_of_file_) return std::string_view{};
  count = std::min(count, end_of_file_ - offset);
  const auto wanted = static_cast<std::size_t>(count);
  if (offset >= first_ && offset - first_ <= held_ && held_ - (offset - first_) >= wanted)
    return std::string_view(room_.get() + (offset - first_), wanted);
  // Small pieces are read many at a time; a large one includes only the beginning of the next.
  constexpr std::size_t ahead = std::size_t{64} << 10;
  const auto target =
      static_cast<std::size_t>(std::min<std::uint64_t>(count + ahead, end_of_file_ - offset));
  std::size_t kept = 0;
  if (offset >= first_ && offset - first_ < held_) {
    kept = held_ - static_cast<std::size_t>(offset - first_);
    std::memmove(room_.get(), room_.get() + (held_ - kept), kept);
  }
  if (target > room_bytes_) {
    auto larger = std::make_unique_for_overwrite<char[]>(target);
    if (kept > 0) std::memcpy(larger.get(), room_.get(), kept);
    room_ = std::move(larger);
    room_bytes_ = target;
  }
  first_ = offset;
  held_ = kept;
  const auto read = bytes_->read_at(offset + kept, std::span(room_.get() + kept, target - kept));
  if (!read) return read.error();
  held_ += *read;
  return std::string_view(room_.get(), std::min(wanted, held_));
}

}  // namespace proofmass::io
