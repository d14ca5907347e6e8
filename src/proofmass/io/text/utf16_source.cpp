#include <algorithm>
#include <array>
#include <cstring>

#include "proofmass/core/utf8.hpp"
#include "proofmass/io/bytes/byte_source.hpp"

namespace proofmass::io {
namespace {

class Utf16Source final : public ByteSource {
 public:
  Utf16Source(std::unique_ptr<ByteSource> source, bool big_endian)
      : source_(std::move(source)), high_first_(big_endian) {}

  Result<std::size_t> read(std::span<char> into) override {
    while (taken_ == text_.size()) {
      text_.clear();
      taken_ = 0;
      const auto count = source_->read(std::span(units_).subspan(kept_));
      if (!count) return count.error();
      if (*count == 0) return std::size_t{0};
      convert(kept_ + *count);
    }
    const std::size_t count = std::min(into.size(), text_.size() - taken_);
    std::memcpy(into.data(), text_.data() + taken_, count);
    taken_ += count;
    return count;
  }
  [[nodiscard]] double fraction_read() const override { return source_->fraction_read(); }
  [[nodiscard]] std::vector<Note> notes() const override { return source_->notes(); }

 private:
  void convert(std::size_t bytes) {
    std::size_t i = 0;
    for (; i + 1 < bytes; i += 2) {
      const auto first = static_cast<unsigned char>(units_[i]);
      const auto second = static_cast<unsigned char>(units_[i + 1]);
      append(high_first_ ? (first << 8) | second : (second << 8) | first);
    }
    kept_ = bytes - i;
    if (kept_ == 1) units_[0] = units_[i];
  }

  void append(int unit) {
    const auto code = static_cast<std::uint32_t>(unit);
    if (code >= 0xD800 && code < 0xDC00) {
      high_surrogate_ = code;
      return;
    }
    if (code >= 0xDC00 && code < 0xE000) {
      if (high_surrogate_ != 0)
        append_utf8(text_, 0x10000 + ((high_surrogate_ - 0xD800) << 10) + (code - 0xDC00));
    } else {
      append_utf8(text_, code);
    }
    high_surrogate_ = 0;
  }

  std::unique_ptr<ByteSource> source_;
  bool high_first_;
  std::array<char, 1 << 15> units_{};
  std::size_t kept_ = 0;  ///< half a code unit, left from the previous piece
  std::uint32_t high_surrogate_ = 0;
  std::string text_;
  std::size_t taken_ = 0;
};

}  // namespace

std::unique_ptr<ByteSource> utf8_from_utf16(std::unique_ptr<ByteSource> source, bool big_endian) {
  return std::make_unique<Utf16Source>(std::move(source), big_endian);
}

}  // namespace proofmass::io
