#pragma once

#include <cstdint>
#include <string_view>

namespace proofmass::io {

/// The checksum of zlib, PNG and MCAP, updated with further bytes; the initial value is 0.
/// Source: ISO 3309; V. Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ
/// Instruction", Intel, 2009, for processors with carry-less multiplication.
[[nodiscard]] std::uint32_t crc32(std::uint32_t so_far, std::string_view bytes);

}  // namespace proofmass::io
