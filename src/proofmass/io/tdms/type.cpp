#include "proofmass/io/tdms/type.hpp"

#include <array>
#include <fmt/format.h>

namespace proofmass::io {
namespace {

constexpr std::uint32_t complex_single = 0x08000C;
constexpr std::uint32_t complex_double = 0x10000D;

}  // namespace

std::size_t bytes_of(TdmsKind kind) {
  constexpr std::array<std::size_t, 14> sizes{1, 2, 4, 8, 1, 2, 4, 8, 4, 8, 1, 16, 0, 0};
  return sizes[static_cast<std::size_t>(kind)];
}

TdmsKind tdms_kind(std::uint32_t type) {
  if (type >= 1 && type <= 10) return static_cast<TdmsKind>(type - 1);
  switch (type) {
    case 0x19:
      return TdmsKind::f32;
    case 0x1A:
      return TdmsKind::f64;
    case 0x20:
      return TdmsKind::text;
    case 0x21:
      return TdmsKind::boolean;
    case 0x44:
      return TdmsKind::instant;
    default:
      return TdmsKind::other;
  }
}

std::optional<TdmsKind> daqmx_kind(std::uint32_t type) {
  constexpr std::array kinds{TdmsKind::u8,  TdmsKind::i8,  TdmsKind::u16, TdmsKind::i16,
                             TdmsKind::u32, TdmsKind::i32, TdmsKind::u64, TdmsKind::i64,
                             TdmsKind::f32, TdmsKind::f64};
  if (type < kinds.size()) return kinds[type];
  return type == 0xFFFFFFFF ? std::optional(TdmsKind::instant) : std::nullopt;
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

}  // namespace proofmass::io
