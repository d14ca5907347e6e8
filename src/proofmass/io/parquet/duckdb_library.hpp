#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"

// DuckDB, which reads and writes Parquet: its C library, loaded on demand.
// Source: DuckDB, "C API", https://duckdb.org/docs/stable/clients/c/api, as of version 1.1.
namespace proofmass::io::parquet {

struct DuckdbCalls;

/// Result of a query, one chunk of rows at a time.
class DuckdbRows {
 public:
  DuckdbRows(const DuckdbCalls& calls, std::unique_ptr<struct DuckdbResult> result);
  DuckdbRows(DuckdbRows&&) noexcept;
  DuckdbRows& operator=(DuckdbRows&&) noexcept;
  DuckdbRows(const DuckdbRows&) = delete;
  DuckdbRows& operator=(const DuckdbRows&) = delete;
  ~DuckdbRows();

  /// Fetches the next chunk: number of rows, 0 at the end. Errors: corrupt, with the library's
  /// message.
  [[nodiscard]] Result<std::size_t> next();
  [[nodiscard]] std::size_t columns() const;
  /// A double column of the chunk, NaN where null.
  void copy(std::size_t column, std::span<double> into) const;
  /// A text or binary field of the chunk; empty if null.
  [[nodiscard]] std::string text(std::size_t column, std::size_t row) const;

 private:
  const DuckdbCalls* calls_;
  std::unique_ptr<struct DuckdbResult> result_;
  void* chunk_ = nullptr;
};

/// Appends rows of doubles to a table.
class DuckdbAppender {
 public:
  DuckdbAppender(const DuckdbCalls& calls, void* appender, std::size_t columns);
  DuckdbAppender(DuckdbAppender&&) noexcept;
  DuckdbAppender& operator=(DuckdbAppender&&) = delete;
  DuckdbAppender(const DuckdbAppender&) = delete;
  DuckdbAppender& operator=(const DuckdbAppender&) = delete;
  ~DuckdbAppender();

  /// Columns of equal length, one per table column. Errors: unreadable, with the library's message.
  [[nodiscard]] Status append(std::span<const std::span<const double>> columns);
  [[nodiscard]] Status close();

 private:
  [[nodiscard]] Error failed() const;

  const DuckdbCalls* calls_;
  void* appender_;
  void* chunk_;
  std::size_t columns_;
};

/// An open database of DuckDB.
class Duckdb {
 public:
  /// Loads the library and opens a database: a file, or one in memory if `database` is empty. It
  /// loads no extensions.
  /// Errors: unsupported (no such library, or a function is missing), unreadable.
  [[nodiscard]] static Result<Duckdb> open(const std::string& library, const std::string& database);

  Duckdb(Duckdb&& other) noexcept;
  Duckdb& operator=(Duckdb&&) = delete;
  Duckdb(const Duckdb&) = delete;
  Duckdb& operator=(const Duckdb&) = delete;
  ~Duckdb();

  /// Errors: corrupt, with the library's message, one line.
  [[nodiscard]] Status run(const std::string& sql) const;
  [[nodiscard]] Result<DuckdbRows> query(const std::string& sql) const;
  [[nodiscard]] Result<DuckdbAppender> append_to(const std::string& table,
                                                 std::size_t columns) const;

 private:
  Duckdb(std::unique_ptr<DuckdbCalls> calls, void* database, void* connection);

  std::unique_ptr<DuckdbCalls> calls_;
  void* database_;
  void* connection_;
};

/// 'a text', "a name", quoted for SQL.
[[nodiscard]] std::string sql_text(std::string_view text);
[[nodiscard]] std::string sql_name(std::string_view name);

}  // namespace proofmass::io::parquet
