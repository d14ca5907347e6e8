#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io::parquet {

/// Maximum number of columns that are read from a table.
inline constexpr std::size_t most_columns = 4096;

/// A column to be read, as doubles.
struct Column {
  std::string name;
  std::string unit;  ///< as written by Proofmass, or "ns" for timestamps; empty: unknown
  std::string type;  ///< DuckDB's: "FLOAT", "TIMESTAMP_NS"
};

/// Information on a Parquet file before its first row.
struct Head {
  std::vector<Column> columns;
  std::uint64_t rows = 0;
  std::map<std::string, std::string, std::less<>> facts;  ///< key-value metadata
  std::string skipped;                                    ///< "note (VARCHAR)"; empty: none
  /// The time column, whose values are relative to an origin: for integers and timestamps an exact
  /// one, or if is_since_start the start given in the metadata.
  std::optional<std::size_t> stamps;
  std::int64_t origin = 0;
  bool is_since_start = false;

  /// Empty if there is no such key.
  [[nodiscard]] std::string_view fact(std::string_view key) const;
  /// The labels in the metadata; none if they are not in Proofmass's format.
  [[nodiscard]] std::vector<Label> labels() const;
};

/// Serialises a head; the decoder trusts nothing. Errors of decode: corrupt.
[[nodiscard]] std::string encode(const Head& head);
[[nodiscard]] Result<Head> decode(std::string_view bytes);

/// Total size of the encoded head that begins with `bytes`; nullopt if these are too few.
[[nodiscard]] std::optional<std::uint64_t> head_bytes(std::string_view bytes);

/// Reads a file by DuckDB, in a child process: passes on the encoded head, then blocks of rows,
/// each of at most most_frame_bytes, column by column, NaN for missing values. Errors: unsupported
/// (no library), corrupt, too_few_samples (no numeric column).
[[nodiscard]] Status read_values(const std::string& path,
                                 const ReadOptions& options,
                                 const ByteSink& sink);

}  // namespace proofmass::io::parquet
