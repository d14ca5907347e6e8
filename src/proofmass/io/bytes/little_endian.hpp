#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "proofmass/core/view.hpp"

namespace proofmass::io {

/// Appends the lowest `count` bytes of a number, lowest first.
inline void append_little_endian(std::string& out, std::uint64_t value, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

/// Appends a number of any type.
template <class T>
void append_value(std::string& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  out.append(bytes.data(), bytes.size());
}

/// Appends doubles in little-endian order.
inline void append_doubles(std::string& out, View<double> values) {
  if constexpr (std::endian::native == std::endian::little) {
    if (!values.empty())
      out.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  } else {
    for (const double value : values) append_value(out, value);
  }
}

/// Loads little-endian doubles from any alignment.
inline void load_doubles(const char* bytes, std::span<double> into) {
  if (into.empty()) return;
  std::memcpy(into.data(), bytes, into.size_bytes());
  if constexpr (std::endian::native == std::endian::big) {
    for (double& value : into)
      value = std::bit_cast<double>(__builtin_bswap64(std::bit_cast<std::uint64_t>(value)));
  }
}

}  // namespace proofmass::io
