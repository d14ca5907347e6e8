#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace proofmass::io {

// The figures of a pyramid are written and read as they lie in memory.
static_assert(std::endian::native == std::endian::little);

/// In front of the header's text in an .npy of version 1: magic, version, length.
inline constexpr std::size_t npy_magic_bytes = 10;

/// The .npy name of the types that a pyramid's arrays are of.
template <class T>
constexpr std::string_view type_of() {
  if constexpr (std::is_same_v<T, double>) return "<f8";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "<u4";
  return "<i8";
}

}  // namespace proofmass::io
