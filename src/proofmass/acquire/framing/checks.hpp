#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace proofmass::acquire {

/// Checksum at the end of a frame, or anywhere in it, over all preceding bytes.
/// Source: G. Cook, Catalogue of parametrised CRC algorithms: CRC-8/SMBUS, CRC-16/CCITT-FALSE
/// (IBM-3740), CRC-16/MODBUS, CRC-32/ISO-HDLC.
enum class Check { crc8, crc16, crc16_modbus, crc32 };

/// By its word in fields=: "crc8", "crc16", "crc16-modbus", "crc32".
[[nodiscard]] std::optional<Check> check_called(std::string_view word);
[[nodiscard]] std::size_t bytes_of(Check check);
[[nodiscard]] std::uint32_t checksum(Check check, std::string_view bytes);

}  // namespace proofmass::acquire
