#include "proofmass/acquire/framing/checks.hpp"

#include <array>
#include <boost/crc.hpp>
#include <utility>

#include "proofmass/io/bytes/crc32.hpp"

namespace proofmass::acquire {
namespace {

template <class Crc>
std::uint32_t sum_of(std::string_view bytes) {
  Crc crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

// Width, polynomial, initial value, final exclusive or, bits of each byte and of the sum reflected.
using Crc8 = boost::crc_optimal<8, 0x07, 0, 0, false, false>;
using Crc16CcittFalse = boost::crc_optimal<16, 0x1021, 0xFFFF, 0, false, false>;
using Crc16Modbus = boost::crc_optimal<16, 0x8005, 0xFFFF, 0, true, true>;

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
      return sum_of<Crc8>(bytes);
    case Check::crc16:
      return sum_of<Crc16CcittFalse>(bytes);
    case Check::crc16_modbus:
      return sum_of<Crc16Modbus>(bytes);
    case Check::crc32:
      break;
  }
  return io::crc32(0, bytes);
}

}  // namespace proofmass::acquire
