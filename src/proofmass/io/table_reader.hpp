#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// The column declared by the format as the time.
struct DeclaredStamps {
  std::size_t column = 0;
  Unit unit;           ///< Quantity::time
  StampOrigin origin;  ///< exact; the column's values are relative to it
};

/// Information on a table before its rows are read.
struct TableHead {
  std::string format;                 ///< "TDMS", "MCAP"
  std::size_t columns = 0;            ///< at least one
  std::vector<std::string> headings;  ///< one per column, with units: "Acc_X (g)"; empty: no names
  std::optional<DeclaredStamps> stamps;  ///< none: found by name, as in a CSV
  std::optional<double> rate_hz;         ///< if the file states it
  /// Time of row 0 on the file's clock, if rate_hz and no column gives the times.
  std::optional<std::int64_t> start_ns;
  std::optional<std::uint64_t> rows;  ///< if known; fewer may follow
  std::vector<Note> notes;            ///< detected, inferred and selected properties, with reasons
};

/// A numeric table that is read once, sequentially, in blocks. Implemented by the reader of a
/// binary format; recording_reader_of() makes a recording of it.
class TableReader {
 public:
  TableReader() = default;
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;
  virtual ~TableReader() = default;

  [[nodiscard]] virtual const TableHead& head() const = 0;
  /// Fills the beginning of the columns with the same number of rows, NaN where the file has no
  /// value, and returns that number; 0 only at the end. `into` has head().columns spans of equal
  /// length.
  /// Errors: corrupt, unreadable: nothing more can be read. Recoverable faults are reported in
  /// notes() instead.
  [[nodiscard]] virtual Result<std::size_t> read(std::span<const std::span<double>> into) = 0;
  /// Faults found while reading, complete once read() has returned 0: a truncated file, …
  [[nodiscard]] virtual std::vector<Note> notes() const { return {}; }
  /// Fraction of the table read, in [0, 1].
  [[nodiscard]] virtual double fraction_read() const = 0;
};

}  // namespace proofmass::io
