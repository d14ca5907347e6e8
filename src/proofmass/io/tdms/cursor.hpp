#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"

namespace proofmass::io::tdms {

/// The bytes of `T` reversed if the file's byte order differs from this machine's.
template <class T>
[[nodiscard]] T from_file_order(std::array<char, sizeof(T)> bytes, bool big_endian) {
  if (big_endian == (std::endian::native == std::endian::little))
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  return std::bit_cast<T>(bytes);
}

/// "byte 28: what".
[[nodiscard]] Error at_byte(std::uint64_t position, std::string_view what);

/// Reads the lead-ins and metadata of a TDMS file, a sequence of small values. Beyond the end of
/// the region it returns zeros and is broken from then on.
class Cursor {
 public:
  /// `bytes` must outlive the cursor.
  explicit Cursor(const RandomBytes& bytes) : bytes_(bytes), size_(bytes.size()) {}

  /// Precondition: from <= to <= size of the file.
  void enter(std::uint64_t from, std::uint64_t to, bool big_endian);
  void set_big_endian(bool big_endian) { big_endian_ = big_endian; }
  [[nodiscard]] bool big_endian() const { return big_endian_; }

  [[nodiscard]] std::uint64_t position() const { return position_; }
  [[nodiscard]] std::uint64_t left() const { return end_ - position_; }
  /// True if a read went beyond the region.
  [[nodiscard]] bool broken() const { return broken_; }
  /// The error if the file could not be read.
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

  template <class T>
  [[nodiscard]] T take() {
    std::array<char, sizeof(T)> raw{};
    fetch(raw);
    return from_file_order<T>(raw, big_endian_);
  }
  /// A length followed by as many bytes, of which 64 KiB are kept.
  [[nodiscard]] std::string take_text();
  void skip(std::uint64_t count);
  /// All bytes from `from` to the current position if they are at most `most`; else empty.
  [[nodiscard]] std::string copy_since(std::uint64_t from, std::size_t most);

 private:
  void fetch(std::span<char> into);

  const RandomBytes& bytes_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
  std::uint64_t end_ = 0;
  bool big_endian_ = false;
  bool broken_ = false;
  std::optional<Error> failure_;
  std::vector<char> window_;
  std::uint64_t window_at_ = 0;
  std::size_t window_size_ = 0;
};

}  // namespace proofmass::io::tdms
