#include "proofmass/io/tdms/decode.hpp"

#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::tdms {
namespace {

template <std::size_t N>
using Bits = std::conditional_t<
    N == 1,
    std::uint8_t,
    std::conditional_t<N == 2,
                       std::uint16_t,
                       std::conditional_t<N == 4, std::uint32_t, std::uint64_t>>>;

template <class T>
T load(const char* p, bool swap) {
  Bits<sizeof(T)> bits;
  std::memcpy(&bits, p, sizeof bits);
  if constexpr (sizeof(T) == 2) {
    if (swap) bits = __builtin_bswap16(bits);
  } else if constexpr (sizeof(T) == 4) {
    if (swap) bits = __builtin_bswap32(bits);
  } else if constexpr (sizeof(T) == 8) {
    if (swap) bits = __builtin_bswap64(bits);
  }
  return std::bit_cast<T>(bits);
}

/// One loop for each type and byte order, and for contiguous values: the compiler can then
/// vectorise it.
template <class T>
void convert(const char* first, std::size_t stride, bool swap, std::span<double> into) {
  double* const out = into.data();
  const std::size_t count = into.size();
  if (stride == sizeof(T) && !swap) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<double>(load<T>(first + i * sizeof(T), false));
  } else if (stride == sizeof(T)) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<double>(load<T>(first + i * sizeof(T), true));
  } else if (!swap) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<double>(load<T>(first + i * stride, false));
  } else {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<double>(load<T>(first + i * stride, true));
  }
}

void convert_instants(const char* first,
                      std::size_t stride,
                      const Encoding& encoding,
                      std::span<double> into) {
  for (std::size_t i = 0; i < into.size(); ++i) {
    const Instant instant = load_instant(first + i * stride, encoding.big_endian);
    into[i] = instant.is_set() ? static_cast<double>(instant.wide_ns() - encoding.origin_ns) / 1e9
                               : std::numeric_limits<double>::quiet_NaN();
  }
}

void pick_bit(std::uint8_t bit, std::span<double> values) {
  for (double& value : values)
    value = (static_cast<std::int64_t>(value) >> bit & 1) != 0 ? 1.0 : 0.0;
}

}  // namespace

Instant load_instant(const char* bytes, bool big_endian) {
  const bool swap = big_endian == (std::endian::native == std::endian::little);
  Instant instant;
  instant.seconds = load<std::int64_t>(bytes + (big_endian ? 0 : 8), swap);
  instant.fraction = load<std::uint64_t>(bytes + (big_endian ? 8 : 0), swap);
  return instant;
}

void decode(const char* first,
            std::size_t stride,
            const Encoding& encoding,
            std::span<double> into) {
  const bool swap = encoding.big_endian == (std::endian::native == std::endian::little);
  switch (encoding.kind) {
    case Kind::i8:
      convert<std::int8_t>(first, stride, swap, into);
      break;
    case Kind::i16:
      convert<std::int16_t>(first, stride, swap, into);
      break;
    case Kind::i32:
      convert<std::int32_t>(first, stride, swap, into);
      break;
    case Kind::i64:
      convert<std::int64_t>(first, stride, swap, into);
      break;
    case Kind::u8:
    case Kind::boolean:
      convert<std::uint8_t>(first, stride, swap, into);
      break;
    case Kind::u16:
      convert<std::uint16_t>(first, stride, swap, into);
      break;
    case Kind::u32:
      convert<std::uint32_t>(first, stride, swap, into);
      break;
    case Kind::u64:
      convert<std::uint64_t>(first, stride, swap, into);
      break;
    case Kind::f32:
      convert<float>(first, stride, swap, into);
      break;
    case Kind::f64:
      convert<double>(first, stride, swap, into);
      break;
    case Kind::instant:
      convert_instants(first, stride, encoding, into);
      break;
    case Kind::text:
    case Kind::other:
      PM_EXPECTS(false);
  }
  if (encoding.bit != Scaler::no_bit) pick_bit(encoding.bit, into);
}

}  // namespace proofmass::io::tdms
