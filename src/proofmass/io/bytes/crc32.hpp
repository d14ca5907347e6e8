#pragma once

#include <cstdint>
#include <string_view>

namespace proofmass::io {

/// The checksum of zlib, PNG and MCAP, updated with further bytes; the initial value is 0.
/// Source: ISO 3309. Computed by libdeflate: 28 GB/s with carry-less multiplication, zlib's 5 GB/s.
[[nodiscard]] std::uint32_t crc32(std::uint32_t so_far, std::string_view bytes);

}  // namespace proofmass::io
