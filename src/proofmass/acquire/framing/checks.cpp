#include "proofmass/acquire/framing/checks.hpp"

#include <array>
#include <utility>

#include "proofmass/io/bytes/crc32.hpp"

namespace proofmass::acquire {
namespace {

/// Most significant bit first, polynomial 0x07, initial value 0.
std::uint32_t crc8(std::string_view bytes) {
  unsigned sum = 0;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum << 1 ^ ((sum & 0x80) != 0 ? 0x07u : 0u)) & 0xFF;
  }
  return sum;
}

/// Most significant bit first, polynomial 0x1021, initial value 0xFFFF.
std::uint32_t crc16_ccitt_false(std::string_view bytes) {
  unsigned sum = 0xFFFF;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned>(static_cast<unsigned char>(c)) << 8;
    for (int bit = 0; bit < 8; ++bit)
      sum = (sum << 1 ^ ((sum & 0x8000) != 0 ? 0x1021u : 0u)) & 0xFFFF;
  }
  return sum;
}

/// Least significant bit first, polynomial 0x8005, initial value 0xFFFF.
std::uint32_t crc16_modbus(std::string_view bytes) {
  unsigned sum = 0xFFFF;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ ((sum & 1) != 0 ? 0xA001u : 0u);
  }
  return sum;
}

}  // namespace

std::optional<Check> check_called(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, Check>, 4> names{
      {{"crc8", Check::crc8},
       {"crc16", Check::crc16},
       {"crc16-modbus", Check::crc16_modbus},
       {"crc32", Check::crc32}}};
  for (const auto& [name, check] : names)
    if (name == word) return check;
  return std::nullopt;
}

std::size_t bytes_of(Check check) {
  return check == Check::crc8 ? 1 : check == Check::crc32 ? 4 : 2;
}

std::uint32_t checksum(Check check, std::string_view bytes) {
  switch (check) {
    case Check::crc8:
      return crc8(bytes);
    case Check::crc16:
      return crc16_ccitt_false(bytes);
    case Check::crc16_modbus:
      return crc16_modbus(bytes);
    case Check::crc32:
      break;
  }
  return io::crc32(0, bytes);
}

}  // namespace proofmass::acquire
