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
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/watched_child.hpp"

namespace proofmass::io {

/// Columns of one table that are read.
inline constexpr std::size_t most_parquet_columns = 4096;

/// A column that is read, as doubles.
struct ParquetColumn {
  std::string name;
  std::string unit;  ///< as Proofmass wrote it, or "ns" of instants; empty: not known
  std::string type;  ///< DuckDB's: "FLOAT", "TIMESTAMP_NS"
};

/// What is known of a Parquet file before its first row.
struct ParquetHead {
  std::vector<ParquetColumn> columns;
  std::uint64_t rows = 0;
  std::map<std::string, std::string, std::less<>> facts;  ///< key-value metadata
  std::string skipped;                                    ///< "note (VARCHAR)"; empty: nothing
  /// The column of the time, where its figures are less an origin: that of integers and instants,
  /// which is exact, or where is_since_start the start that the metadata tell.
  std::optional<std::size_t> stamps;
  std::int64_t origin = 0;
  bool is_since_start = false;

  /// Empty where there is none of that key.
  [[nodiscard]] std::string_view fact(std::string_view key) const;
  /// Those in the metadata; none where they are not spelt as Proofmass does.
  [[nodiscard]] std::vector<Label> labels() const;
};

/// A head as bytes and back, which believes nothing. Errors of decode_parquet: corrupt.
[[nodiscard]] std::string encode_parquet(const ParquetHead& head);
[[nodiscard]] Result<ParquetHead> decode_parquet(std::string_view bytes);

/// How many bytes the encoded head has, of which `bytes` are the first; nullopt where they are too
/// few to say.
[[nodiscard]] std::optional<std::uint64_t> parquet_head_bytes(std::string_view bytes);

/// Reads a file by DuckDB, for a process of its own: hands on the encoded head, then blocks of
/// rows, each of at most most_frame_bytes, column by column, NaN where there is no figure. Errors:
/// unsupported (no library), corrupt, too_few_samples (no column of numbers).
[[nodiscard]] Status read_parquet(const std::string& path,
                                  const ReadOptions& options,
                                  const ByteSink& sink);

}  // namespace proofmass::io
