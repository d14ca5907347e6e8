#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/cursor.hpp"
#include "proofmass/io/tdms/type.hpp"

namespace proofmass::io::tdms {

/// Position of one of a channel's values in the rows of a DAQmx buffer.
struct Scaler {
  Kind kind = Kind::i16;
  std::uint32_t buffer = 0;
  std::uint32_t offset = 0;  ///< bytes from the start of the row
  std::uint8_t bit = no_bit;
  std::uint32_t id = 0;
  static constexpr std::uint8_t no_bit = 255;
};

/// Description of a channel's values in each chunk of a segment.
struct Index {
  std::uint32_t type = 0;
  Kind kind = Kind::other;
  std::uint64_t values = 0;
  std::uint64_t bytes = 0;            ///< total size of text
  std::vector<Scaler> scalers;        ///< for DAQmx raw data; else empty
  std::vector<std::uint32_t> widths;  ///< bytes per row of each DAQmx buffer
};

/// Reads an index after its first word, `header`, which gives its type. Errors: corrupt (an
/// impossible index). If the file is truncated, the cursor is broken.
[[nodiscard]] Result<Index> take_index(Cursor& cursor, std::uint32_t header);

/// All properties of an index, as a key.
[[nodiscard]] std::string key_of(const Index& index);

}  // namespace proofmass::io::tdms
