#include "proofmass/io/tdms/type.hpp"

#include <array>
#include <fmt/format.h>

namespace proofmass::io::tdms {
namespace {

constexpr std::uint32_t complex_single = 0x08000C;
constexpr std::uint32_t complex_double = 0x10000D;

}  // namespace

std::size_t bytes_per_value(Kind kind) {
  constexpr std::array<std::size_t, 14> sizes{1, 2, 4, 8, 1, 2, 4, 8, 4, 8, 1, 16, 0, 0};
  return sizes[static_cast<std::size_t>(kind)];
}

Kind kind_of(std::uint32_t type) {
  if (type >= 1 && type <= 10) return static_cast<Kind>(type - 1);
  switch (type) {
    case 0x19:
      return Kind::f32;
    case 0x1A:
      return Kind::f64;
    case 0x20:
      return Kind::text;
    case 0x21:
      return Kind::boolean;
    case 0x44:
      return Kind::instant;
    default:
      return Kind::other;
  }
}

std::optional<Kind> daqmx_kind(std::uint32_t type) {
  constexpr std::array kinds{Kind::u8,  Kind::i8,  Kind::u16, Kind::i16, Kind::u32,
                             Kind::i32, Kind::u64, Kind::i64, Kind::f32, Kind::f64};
  if (type < kinds.size()) return kinds[type];
  return type == 0xFFFFFFFF ? std::optional(Kind::instant) : std::nullopt;
}

std::string words_for_type(std::uint32_t type) {
  switch (type) {
    case 0x0B:
    case 0x1B:
      return "extended-precision numbers";
    case 0x4F:
      return "fixed-point numbers";
    case complex_single:
    case complex_double:
      return "complex numbers";
    default:
      return fmt::format("values of type 0x{:X}", type);
  }
}

std::size_t bytes_of_other(std::uint32_t type) {
  if (type == complex_single) return 8;
  return type == complex_double ? 16 : 0;
}

}  // namespace proofmass::io::tdms
