#include "proofmass/io/arrays/figure_column.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

namespace proofmass::io {
namespace {

template <class T>
void load_native(const char* bytes, std::size_t stride, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    T value;
    std::memcpy(&value, bytes + i * stride, sizeof value);
    out[i] = static_cast<double>(value);
  }
}

void load_whole_of_3_bytes(const char* bytes,
                           std::size_t stride,
                           const FigureType& type,
                           std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const char* const p = bytes + i * stride;
    const auto byte = [&](std::size_t place) {
      return std::uint32_t{static_cast<unsigned char>(p[type.big_endian ? 2 - place : place])};
    };
    const std::uint32_t bits = byte(2) << 24 | byte(1) << 16 | byte(0) << 8;
    out[i] = type.kind == 'u' ? static_cast<double>(bits >> 8)
                              : static_cast<double>(static_cast<std::int32_t>(bits) >> 8);
  }
}

}  // namespace

void load_figures(const char* bytes,
                  std::size_t stride,
                  const FigureType& type,
                  std::span<double> out) {
  const bool is_native = type.big_endian == (std::endian::native == std::endian::big);
  if (type.bytes == 3) return load_whole_of_3_bytes(bytes, stride, type, out);
  if (is_native && type.kind == 'f' && type.bytes == 8)
    return load_native<double>(bytes, stride, out);
  if (is_native && type.kind == 'f' && type.bytes == 4)
    return load_native<float>(bytes, stride, out);
  if (is_native && type.kind == 'i' && type.bytes == 2)
    return load_native<std::int16_t>(bytes, stride, out);
  if (is_native && type.kind == 'i' && type.bytes == 4)
    return load_native<std::int32_t>(bytes, stride, out);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = load_figure(bytes + i * stride, type);
}

}  // namespace proofmass::io
