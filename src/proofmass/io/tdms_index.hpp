#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms_cursor.hpp"
#include "proofmass/io/tdms_type.hpp"

namespace proofmass::io {

/// Where in the rows of a DAQmx buffer one of a channel's figures lies.
struct TdmsScaler {
  TdmsKind kind = TdmsKind::i16;
  std::uint32_t buffer = 0;
  std::uint32_t offset = 0;  ///< bytes from the row's front
  std::uint8_t bit = no_bit;
  std::uint32_t id = 0;
  static constexpr std::uint8_t no_bit = 255;
};

/// What a segment says of a channel's values in each of its chunks.
struct TdmsIndex {
  std::uint32_t type = 0;
  TdmsKind kind = TdmsKind::other;
  std::uint64_t values = 0;
  std::uint64_t bytes = 0;            ///< of text
  std::vector<TdmsScaler> scalers;    ///< of DAQmx raw data; else empty
  std::vector<std::uint32_t> widths;  ///< bytes a row of each DAQmx buffer
};

/// Reads an index behind its first word, `header`, which says of what sort it is.
/// Errors: corrupt (what no index can be). Where the file breaks off the cursor says so.
[[nodiscard]] Result<TdmsIndex> read_tdms_index(TdmsCursor& cursor, std::uint32_t header);

/// All that an index says, as a key.
[[nodiscard]] std::string key_of(const TdmsIndex& index);

}  // namespace proofmass::io
