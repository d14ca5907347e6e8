#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace proofmass {

/// The state of an object as bytes. The same function of the object, exchange(StateBytes&), writes
/// and reads it, by naming its members in order; the object checks what it has read.
///
/// Reading never goes beyond the bytes and allocates no more than they fill: after the first value
/// that is not there, failed() is true and all further values are zero or empty. In the byte order
/// of the machine.
class StateBytes {
 public:
  StateBytes() = default;  ///< to write
  explicit StateBytes(std::string_view bytes) : left_(bytes), reading_(true) {}

  template <class T>
    requires std::is_arithmetic_v<T>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = value ? 1 : 0;
      copy(&byte, 1);
      value = byte == 1;
      if (byte > 1) fail();
    } else {
      copy(&value, sizeof value);
    }
  }
  void operator()(std::string& text) {
    text.resize(size(text.size(), 1));
    copy(text.data(), text.size());
  }
  template <class T>
    requires std::is_arithmetic_v<T>
  void operator()(std::vector<T>& values) {
    values.resize(size(values.size(), sizeof(T)));
    copy(values.data(), values.size() * sizeof(T));
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    bool is_there = value.has_value();
    (*this)(is_there);
    if (!is_there) return value.reset();
    if (!value) value.emplace();
    (*this)(*value);
  }
  /// The number of elements of a list, each of which fills at least `least_bytes`.
  [[nodiscard]] std::size_t size(std::size_t count, std::size_t least_bytes);

  [[nodiscard]] bool reading() const { return reading_; }
  void fail() { failed_ = true; }
  [[nodiscard]] bool failed() const { return failed_; }
  /// Whether all bytes have been read, without failure.
  [[nodiscard]] bool complete() const { return !failed_ && left_.empty(); }
  /// What has been written.
  [[nodiscard]] std::string bytes() && { return std::move(written_); }

 private:
  void copy(void* value, std::size_t count);

  std::string written_;
  std::string_view left_;
  bool reading_ = false, failed_ = false;
};

}  // namespace proofmass
