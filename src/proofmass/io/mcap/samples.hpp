#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::io::mcap {

/// Our own message encoding: blocks of samples, little-endian.
///   byte 0  u8   version, 1
///        1  u8   flags; bit 0: has stamps
///        2  u16  columns
///        4  u32  rows
///        8  u64  number of the first row, from 0 at the recording's first sample
///       16  f64  stamps, one per row: seconds from the recording's first sample
///           f64  column by column, one value per row
inline constexpr std::string_view samples_encoding = "proofmass-samples";
inline constexpr std::size_t samples_head_bytes = 16;

/// Description of these blocks in the schema and the channel.
struct SamplesLayout {
  struct Column {
    std::string name;
    std::string unit;  ///< symbol; may be empty
  };
  std::vector<Column> columns;
  bool has_stamps = false;
  std::optional<double> rate_hz;         ///< if there are no stamps
  std::optional<std::int64_t> start_ns;  ///< time of the first sample
  std::string derived_from{};            ///< topic from which it was computed; empty: measured
};

struct SamplesHead {
  bool has_stamps = false;
  std::uint16_t columns = 0;
  std::uint32_t rows = 0;
  std::uint64_t first = 0;
};

/// Reads a block's header and checks it against the available bytes. Errors: corrupt (a length
/// other than stated), unsupported (another version).
[[nodiscard]] Result<SamplesHead> read_samples_head(std::string_view message);
/// Replaces the bytes by an encoded block.
void write_samples(std::uint64_t first,
                   View<double> stamps_s,
                   std::span<const View<double>> columns,
                   std::string& message);

/// The JSON schema: `columns` lists name and unit of each.
[[nodiscard]] std::string samples_schema(const SamplesLayout& layout);
/// Metadata of the channel: "stamps", "rate_hz", "start_ns", "derived_from".
[[nodiscard]] std::map<std::string, std::string> samples_metadata(const SamplesLayout& layout);
/// Errors: corrupt (not such a schema).
[[nodiscard]] Result<SamplesLayout> read_samples_layout(
    std::string_view schema, const std::map<std::string, std::string>& metadata);

}  // namespace proofmass::io::mcap
