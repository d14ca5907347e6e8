#include "proofmass/io/tdms/cursor.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::tdms {
namespace {

/// Several segments of a fragmented file at once, and little if segments are large.
constexpr std::uint64_t window_bytes = 16 << 10;
constexpr std::uint64_t longest_text = 64 << 10;

}  // namespace

Error at_byte(std::uint64_t position, std::string_view what) {
  return {Errc::corrupt, fmt::format("byte {}: {}", position, what)};
}

void Cursor::enter(std::uint64_t from, std::uint64_t to, bool big_endian) {
  PM_EXPECTS(from <= to && to <= size_);
  position_ = from;
  end_ = to;
  big_endian_ = big_endian;
  broken_ = false;
}

void Cursor::fetch(std::span<char> into) {
  if (into.size() > left()) {
    broken_ = true;
    position_ = end_;
    return;
  }
  while (!into.empty()) {
    if (position_ < window_at_ || position_ >= window_at_ + window_size_) {
      window_.resize(static_cast<std::size_t>(std::min(window_bytes, size_)));
      const auto count = bytes_.read_at(position_, window_);
      window_at_ = position_;
      window_size_ = count ? *count : 0;
      if (!count) failure_ = count.error();
      if (window_size_ == 0) {
        broken_ = true;
        position_ = end_;
        return;
      }
    }
    const auto at = static_cast<std::size_t>(position_ - window_at_);
    const std::size_t piece = std::min(into.size(), window_size_ - at);
    std::memcpy(into.data(), window_.data() + at, piece);
    into = into.subspan(piece);
    position_ += piece;
  }
}

std::string Cursor::take_text() {
  const std::uint64_t length = take<std::uint32_t>();
  if (length > left()) {
    broken_ = true;
    position_ = end_;
    return {};
  }
  std::string text(static_cast<std::size_t>(std::min(length, longest_text)), '\0');
  fetch(text);
  skip(length - text.size());
  return text;
}

void Cursor::skip(std::uint64_t count) {
  broken_ = broken_ || count > left();
  position_ += std::min(count, left());
}

std::string Cursor::copy_since(std::uint64_t from, std::size_t most) {
  PM_EXPECTS(from <= position_);
  const std::uint64_t size = position_ - from;
  if (size > most || broken_) return {};
  std::string copy(static_cast<std::size_t>(size), '\0');
  position_ = from;
  fetch(copy);
  return copy;
}

}  // namespace proofmass::io::tdms
