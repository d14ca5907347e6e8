#pragma once

#include <cstdint>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/cursor.hpp"

namespace proofmass::io::tdms {

/// The 28 bytes at the beginning of a segment, as file positions.
struct LeadIn {
  static constexpr std::uint64_t bytes = 28;
  enum ContentsBit : std::uint32_t {
    metadata = 1U << 1,
    new_list = 1U << 2,
    raw_data = 1U << 3,
    interleaved = 1U << 5,
    big_endian = 1U << 6,
  };

  std::uint64_t at = 0;
  std::uint32_t contents = 0;
  std::uint32_t version = 0;
  std::uint64_t raw_at = 0;  ///< first byte of the values
  std::uint64_t end = 0;
  bool is_complete = true;     ///< all of its bytes are present
  bool is_unfinished = false;  ///< its length was never written

  [[nodiscard]] bool has(ContentsBit bit) const { return (contents & bit) != 0; }
};

/// Reads the lead-in at byte `at` of a file of `size` bytes.
/// Errors: corrupt, unsupported (an index file), with the byte.
[[nodiscard]] Result<LeadIn> take_lead_in(Cursor& cursor, std::uint64_t at, std::uint64_t size);

}  // namespace proofmass::io::tdms
