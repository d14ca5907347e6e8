#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace proofmass::io {

// The values of a pyramid are written and read in the memory layout.
static_assert(std::endian::native == std::endian::little);

/// Bytes before the header's text in an .npy of version 1: magic, version, length.
inline constexpr std::size_t npy_magic_bytes = 10;

/// The .npy name of the element types of a pyramid's arrays.
template <class T>
constexpr std::string_view type_of() {
  if constexpr (std::is_same_v<T, double>) return "<f8";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "<u4";
  return "<i8";
}

}  // namespace proofmass::io
