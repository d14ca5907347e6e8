#include "proofmass/io/arrays/figure_type.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace proofmass::io {
namespace {

template <class T>
T load(const char* p, bool swap) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), p, sizeof(T));
  if (swap) std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

/// Source: IEEE 754-2019, binary16.
double from_half(std::uint16_t bits) {
  const int exponent = (bits >> 10) & 0x1F;
  const int fraction = bits & 0x3FF;
  double size = 0.0;
  if (exponent == 0x1F)
    size = fraction != 0 ? std::numeric_limits<double>::quiet_NaN()
                         : std::numeric_limits<double>::infinity();
  else if (exponent == 0)
    size = std::ldexp(fraction, -24);
  else
    size = std::ldexp(1024 + fraction, exponent - 25);
  return (bits & 0x8000) != 0 ? -size : size;
}

double load_signed(const char* p, std::size_t bytes, bool swap) {
  switch (bytes) {
    case 1:
      return static_cast<double>(load<std::int8_t>(p, swap));
    case 2:
      return static_cast<double>(load<std::int16_t>(p, swap));
    case 4:
      return static_cast<double>(load<std::int32_t>(p, swap));
    default:
      return static_cast<double>(load<std::int64_t>(p, swap));
  }
}

double load_unsigned(const char* p, std::size_t bytes, bool swap) {
  switch (bytes) {
    case 1:
      return static_cast<double>(load<std::uint8_t>(p, swap));
    case 2:
      return static_cast<double>(load<std::uint16_t>(p, swap));
    case 4:
      return static_cast<double>(load<std::uint32_t>(p, swap));
    default:
      return static_cast<double>(load<std::uint64_t>(p, swap));
  }
}

}  // namespace

double load_figure(const char* bytes, const FigureType& type) {
  const bool swap = type.big_endian == (std::endian::native == std::endian::little);
  if (type.kind == 'i') return load_signed(bytes, type.bytes, swap);
  if (type.kind == 'u' || type.kind == 'b') return load_unsigned(bytes, type.bytes, swap);
  if (type.bytes == 2) return from_half(load<std::uint16_t>(bytes, swap));
  if (type.bytes == 4) return static_cast<double>(load<float>(bytes, swap));
  return load<double>(bytes, swap);
}

}  // namespace proofmass::io
