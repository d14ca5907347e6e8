#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proofmass/core/new_file.hpp"
#include "proofmass/core/result.hpp"

// Tables of figures and texts as Parquet, written without a library: DuckDB, pandas, Arrow and
// Spark read them.
namespace proofmass::io::parquet {

/// A field: null, a number or a text (UTF-8). A number that is not finite is written as null.
using TableCell = std::variant<std::monostate, double, std::string>;

struct TableColumn {
  std::string name;
  bool is_text = false;
};

/// A Parquet file on its way: optional columns of DOUBLE and of UTF-8 BYTE_ARRAY, plain encoding,
/// one page a column and group of rows. It takes its name only in finish(). Source: Apache Parquet
/// format 2.9, README (file layout), Encodings.md (PLAIN, RLE/bit-packed hybrid), parquet.thrift;
/// Apache Thrift, compact protocol specification.
class TableWriter {
 public:
  /// Errors of all: unwritable.
  [[nodiscard]] static Result<TableWriter> create(const std::string& path,
                                                  std::vector<TableColumn> columns);

  /// A group of rows, column by column; all columns are of one length, below 2^28. A figure in a
  /// column of texts is written as its shortest decimal form, a text in one of figures as none.
  [[nodiscard]] Status add(const std::vector<std::vector<TableCell>>& columns);

  [[nodiscard]] Status finish();

 private:
  struct Chunk {
    std::uint64_t offset = 0, bytes = 0;
  };
  struct Group {
    std::uint64_t rows = 0;
    std::vector<Chunk> chunks;
  };
  TableWriter(NewFile file, std::vector<TableColumn> columns);
  [[nodiscard]] Status append(std::string_view bytes);

  NewFile file_;
  std::vector<TableColumn> columns_;
  std::vector<Group> groups_;
  std::uint64_t offset_ = 0;
};

/// A Parquet file's rows as CSV with a line of names, every field quoted, read by DuckDB in a
/// process of its own. Errors: unsupported (no library), corrupt, unreadable.
[[nodiscard]] Result<std::string> as_csv(const std::string& path,
                                         const std::string& duckdb_library);

}  // namespace proofmass::io::parquet
