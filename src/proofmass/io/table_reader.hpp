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

/// The column that a format itself declares to be the time.
struct DeclaredStamps {
  std::size_t column = 0;
  Unit unit;           ///< of its figures; Quantity::time
  StampOrigin origin;  ///< exact; the column's figures are less it
};

/// What a file says of a table before its rows are read.
struct TableHead {
  std::string format;                 ///< "TDMS", "MCAP"
  std::size_t columns = 0;            ///< one at least
  std::vector<std::string> headings;  ///< one a column, unit included: "Acc_X (g)"; empty: no names
  std::optional<DeclaredStamps> stamps;  ///< none: found by name, as in a CSV
  std::optional<double> rate_hz;         ///< if the file says
  /// Time of row 0 on the file's clock, where rate_hz and no column says when rows were taken.
  std::optional<std::int64_t> start_ns;
  std::optional<std::uint64_t> rows;  ///< if known; as many need not come
  std::vector<Note> notes;            ///< what was found, inferred, chosen and why
};

/// A table of figures that is read once, from its first row to its last, a piece at a time. What a
/// reader of a binary format writes; recording_reader_of() makes a recording of it.
class TableReader {
 public:
  TableReader() = default;
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;
  virtual ~TableReader() = default;

  [[nodiscard]] virtual const TableHead& head() const = 0;
  /// Fills the columns from their fronts, all with as many rows, NaN where the file has no figure,
  /// and says how many; 0 only at the end. `into` has head().columns spans of one length.
  /// Errors: corrupt, unreadable: nothing more can be read. What can be salvaged is told in
  /// notes(), not refused.
  [[nodiscard]] virtual Result<std::size_t> read(std::span<const std::span<double>> into) = 0;
  /// What was seen on the way, complete once read() has returned 0: a file that breaks off, …
  [[nodiscard]] virtual std::vector<Note> notes() const { return {}; }
  /// How much of the table is read, in [0, 1].
  [[nodiscard]] virtual double fraction_read() const = 0;
};

}  // namespace proofmass::io
