#include "proofmass/io/text/line_reader.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

constexpr std::size_t piece_bytes = std::size_t{128} << 10;
constexpr std::size_t longest_line = std::size_t{1} << 20;

}  // namespace

LineReader::LineReader(const RandomBytes& file, std::uint64_t offset, std::size_t number)
    : file_(file), buffer_offset_(offset), number_(number - 1) {}

/// Moves the remainder of a line to the front and reads more after it.
Status LineReader::refill() {
  const std::size_t left = filled_ - next_;
  if (left > longest_line)
    return Error{Errc::corrupt, fmt::format("line {}: is longer than 1 MiB: no text", number_ + 1)};
  buffer_offset_ += next_;
  const std::uint64_t ahead = file_.size() - std::min(file_.size(), buffer_offset_ + left);
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(ahead, left + piece_bytes));
  if (left > 0) std::memmove(buffer_.data(), buffer_.data() + next_, left);
  next_ = 0;
  filled_ = left;
  if (buffer_.size() < left + wanted + decimal_padding)
    buffer_.resize(left + wanted + decimal_padding);
  const auto count = file_.read_at(buffer_offset_ + left, std::span(buffer_).subspan(left, wanted));
  if (!count) return count.error();
  filled_ += *count;
  std::memset(buffer_.data() + filled_, '\n', decimal_padding);
  return Done{};
}

Result<bool> LineReader::next() {
  const auto find = [&](std::size_t from) {
    const void* found =
        from == filled_ ? nullptr : std::memchr(buffer_.data() + from, '\n', filled_ - from);
    return static_cast<const char*>(found);
  };
  const char* end = find(next_);
  while (end == nullptr) {
    const std::size_t seen = filled_ - next_;
    if (const Status done = refill(); !done) return done.error();
    if (filled_ == seen) break;
    end = find(seen);
  }
  is_ended_ = end != nullptr;
  const std::size_t size =
      is_ended_ ? static_cast<std::size_t>(end - (buffer_.data() + next_)) : filled_ - next_;
  if (!is_ended_ && size == 0) return false;
  text_ = std::string_view(buffer_).substr(next_, size);
  if (text_.ends_with('\r')) text_.remove_suffix(1);
  offset_ = buffer_offset_ + next_;
  next_ += size + (is_ended_ ? 1 : 0);
  ++number_;
  return true;
}

}  // namespace proofmass::io
