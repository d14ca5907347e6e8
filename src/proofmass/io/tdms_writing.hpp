#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include "proofmass/io/tdms_value.hpp"

namespace proofmass::io {

inline constexpr std::uint32_t tdms_double = 10;

/// A figure, little-endian.
template <class T>
void append_figure(std::string& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

/// A length and as many bytes.
inline void append_text(std::string& out, std::string_view text) {
  append_figure(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

/// Properties of an object, counted as they are added.
class TdmsPropertyList {
 public:
  void text(std::string_view name, std::string_view value) {
    constexpr std::uint32_t type = 0x20;
    begin(name, type);
    append_text(bytes_, value);
  }
  void figure(std::string_view name, double value) {
    begin(name, tdms_double);
    append_figure(bytes_, value);
  }
  void whole(std::string_view name, std::int32_t value) {
    constexpr std::uint32_t type = 3;
    begin(name, type);
    append_figure(bytes_, value);
  }
  void instant(std::string_view name, const TdmsInstant& value) {
    constexpr std::uint32_t type = 0x44;
    begin(name, type);
    append_figure(bytes_, value.fraction);
    append_figure(bytes_, value.seconds);
  }
  /// As a segment lists them.
  void append_to(std::string& out) const {
    append_figure(out, count_);
    out += bytes_;
  }

 private:
  void begin(std::string_view name, std::uint32_t type) {
    ++count_;
    append_text(bytes_, name);
    append_figure(bytes_, type);
  }

  std::uint32_t count_ = 0;
  std::string bytes_;
};

}  // namespace proofmass::io
