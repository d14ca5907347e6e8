#include "proofmass/io/tdms/properties.hpp"

#include <fmt/format.h>
#include <optional>
#include <string>

#include "proofmass/io/tdms/type.hpp"

namespace proofmass::io::tdms {
namespace {

double take_figure(Cursor& cursor, Kind kind) {
  switch (kind) {
    case Kind::i8:
      return cursor.take<std::int8_t>();
    case Kind::i16:
      return cursor.take<std::int16_t>();
    case Kind::i32:
      return cursor.take<std::int32_t>();
    case Kind::i64:
      return static_cast<double>(cursor.take<std::int64_t>());
    case Kind::u8:
    case Kind::boolean:
      return cursor.take<std::uint8_t>();
    case Kind::u16:
      return cursor.take<std::uint16_t>();
    case Kind::u32:
      return cursor.take<std::uint32_t>();
    case Kind::u64:
      return static_cast<double>(cursor.take<std::uint64_t>());
    case Kind::f32:
      return static_cast<double>(cursor.take<float>());
    default:
      return cursor.take<double>();
  }
}

Instant take_instant(Cursor& cursor) {
  Instant instant;
  const bool big_endian = cursor.big_endian();
  if (big_endian) instant.seconds = cursor.take<std::int64_t>();
  instant.fraction = cursor.take<std::uint64_t>();
  if (!big_endian) instant.seconds = cursor.take<std::int64_t>();
  return instant;
}

/// nullopt for a skipped or impossible value.
std::optional<Value> take_value(Cursor& cursor, std::uint32_t type) {
  const Kind kind = kind_of(type);
  if (kind == Kind::text) return cursor.take_text();
  if (kind == Kind::instant) return take_instant(cursor);
  if (kind != Kind::other) return take_figure(cursor, kind);
  cursor.skip(bytes_of_other(type));
  return std::nullopt;
}

}  // namespace

Status read_properties(Cursor& cursor, Properties& properties) {
  const auto count = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && !cursor.broken(); ++i) {
    const std::uint64_t at = cursor.position();
    std::string name = cursor.take_text();
    const auto type = cursor.take<std::uint32_t>();
    if (cursor.broken()) break;
    if (kind_of(type) == Kind::other && bytes_of_other(type) == 0)
      return Error{
          Errc::corrupt,
          fmt::format("byte {}: a property of type 0x{:X}, whose size is not known", at, type)};
    auto value = take_value(cursor, type);
    if (value && !cursor.broken()) properties.insert_or_assign(std::move(name), *std::move(value));
  }
  return Done{};
}

}  // namespace proofmass::io::tdms
