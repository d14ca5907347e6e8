#include "proofmass/io/tdms/index.hpp"

#include <fmt/format.h>
#include <string_view>

#include "proofmass/io/tdms/cursor.hpp"

namespace proofmass::io::tdms {
namespace {

constexpr std::uint32_t format_changing_scaler = 0x1269;
constexpr std::uint32_t digital_line_scaler = 0x126A;
/// The digital line scaler according to NI's description of the format, with four bytes for the
/// sample format instead of the one found in files.
constexpr std::uint32_t digital_line_scaler_as_documented = 0x1369;

bool is_small_integer(Kind kind) {
  return kind != Kind::i64 && kind != Kind::u64 && kind <= Kind::u32;
}

Result<Scaler> take_scaler(Cursor& cursor, std::uint32_t header) {
  const bool is_digital = header != format_changing_scaler;
  const std::uint64_t at = cursor.position();
  Scaler scaler;
  const auto kind = daqmx_kind(cursor.take<std::uint32_t>());
  scaler.buffer = cursor.take<std::uint32_t>();
  scaler.offset = cursor.take<std::uint32_t>();
  if (is_digital) {
    scaler.bit = static_cast<std::uint8_t>(scaler.offset % 8);
    scaler.offset /= 8;
  }
  cursor.skip(header == digital_line_scaler ? 1 : 4);
  scaler.id = cursor.take<std::uint32_t>();
  const bool is_known = kind && (!is_digital || is_small_integer(*kind));
  if (!is_known && !cursor.broken())
    return at_byte(at, "a DAQmx scaler of a type that is not known");
  scaler.kind = kind.value_or(Kind::u8);
  return scaler;
}

/// The remainder of a DAQmx index after its dimension.
Status read_daqmx(Cursor& cursor, std::uint32_t header, Index& index) {
  index.values = cursor.take<std::uint64_t>();
  const auto scalers = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < scalers && !cursor.broken(); ++i) {
    const auto scaler = take_scaler(cursor, header);
    if (!scaler) return scaler.error();
    index.scalers.push_back(*scaler);
  }
  const auto widths = cursor.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < widths && !cursor.broken(); ++i)
    index.widths.push_back(cursor.take<std::uint32_t>());
  if (index.scalers.empty() && !cursor.broken())
    return at_byte(cursor.position(), "a channel of DAQmx raw data without a scaler");
  if (!index.scalers.empty()) index.kind = index.scalers.front().kind;
  return Done{};
}

bool is_daqmx(std::uint32_t header) {
  return header == format_changing_scaler || header == digital_line_scaler ||
         header == digital_line_scaler_as_documented;
}

}  // namespace

Result<Index> take_index(Cursor& cursor, std::uint32_t header) {
  constexpr std::uint32_t longest = 64;  // 20 and 28 are usual
  const std::uint64_t at = cursor.position();
  if (header > longest && !is_daqmx(header))
    return at_byte(at, fmt::format("0x{:X} is not a known raw data index", header));
  Index index;
  index.type = cursor.take<std::uint32_t>();
  index.kind = kind_of(index.type);
  const auto dimension = cursor.take<std::uint32_t>();
  if (dimension != 1 && !cursor.broken())
    return at_byte(at, fmt::format("a channel of {} dimensions: expected 1", dimension));
  if (is_daqmx(header)) {
    if (const Status read = read_daqmx(cursor, header, index); !read) return read.error();
    return index;
  }
  index.values = cursor.take<std::uint64_t>();
  if (index.kind == Kind::text) index.bytes = cursor.take<std::uint64_t>();
  return index;
}

std::string key_of(const Index& index) {
  std::string key = fmt::format("{:x},{:x},{:x}", index.type, index.values, index.bytes);
  for (const Scaler& scaler : index.scalers)
    key += fmt::format(";{:x},{:x},{:x},{:x},{:x}", static_cast<unsigned>(scaler.kind),
                       scaler.buffer, scaler.offset, static_cast<unsigned>(scaler.bit), scaler.id);
  for (const std::uint32_t width : index.widths) key += fmt::format("/{:x}", width);
  return key;
}

}  // namespace proofmass::io::tdms
