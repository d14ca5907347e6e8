#include "proofmass/io/parquet/child.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "proofmass/io/column_names.hpp"
#include "proofmass/io/parquet/duckdb_library.hpp"
#include "proofmass/io/parquet/facts.hpp"

namespace proofmass::io::parquet {
namespace {

bool is_integer(std::string_view type) {
  return type == "BIGINT" || type == "UBIGINT";
}
bool is_instant(std::string_view type) {
  return type.starts_with("TIMESTAMP");
}
bool is_number(std::string_view type) {
  constexpr std::array<std::string_view, 13> numbers{
      "TINYINT",  "SMALLINT", "INTEGER",  "BIGINT", "HUGEINT", "UTINYINT", "USMALLINT",
      "UINTEGER", "UBIGINT",  "UHUGEINT", "FLOAT",  "DOUBLE",  "BOOLEAN"};
  return std::ranges::find(numbers, type) != numbers.end() || type.starts_with("DECIMAL");
}

/// Texts in the first two columns of a query, row by row.
Result<std::vector<std::array<std::string, 2>>> pairs(const Duckdb& database,
                                                      const std::string& sql) {
  std::vector<std::array<std::string, 2>> found;
  auto queried = database.query(sql);
  if (!queried) return queried.error();
  DuckdbRows rows = std::move(queried).value();
  for (;;) {
    const auto count = rows.next();
    if (!count) return count.error();
    if (*count == 0) return found;
    for (std::size_t row = 0; row < *count; ++row)
      found.push_back({rows.text(0, row), rows.columns() > 1 ? rows.text(1, row) : ""});
  }
}

/// Reads one file, its head and then its rows.
class Reading {
 public:
  Reading(Duckdb database, const std::string& path, const ReadOptions& options)
      : database_(std::move(database)),
        from_(fmt::format("read_parquet({})", sql_text(path))),
        path_(sql_text(path)),
        options_(options) {}

  Status run(const ByteSink& sink) {
    for (const auto step : {&Reading::read_facts, &Reading::read_columns, &Reading::read_origin})
      if (const Status done = (this->*step)(); !done) return done;
    if (!sink(encode(head_))) return nobody();
    return read_rows(sink);
  }

 private:
  static Error nobody() { return {Errc::unreadable, "nobody listens"}; }

  Status read_facts() {
    const auto facts =
        pairs(database_, fmt::format("SELECT key, value FROM parquet_kv_metadata({})", path_));
    if (!facts) return facts.error();
    constexpr std::size_t most_facts = 8000;
    for (const auto& [key, value] : *facts)
      if (head_.facts.size() < most_facts) head_.facts.insert_or_assign(key, value);
    const auto rows = pairs(
        database_,
        fmt::format("SELECT CAST(num_rows AS VARCHAR) FROM parquet_file_metadata({})", path_));
    if (!rows) return rows.error();
    for (const auto& [count, none] : *rows)
      std::from_chars(count.data(), count.data() + count.size(), head_.rows);
    return Done{};
  }

  Status read_columns() {
    const auto columns = pairs(database_, "DESCRIBE SELECT * FROM " + from_);
    if (!columns) return columns.error();
    for (const auto& [name, type] : *columns) {
      const bool is_read = (is_number(type) || is_instant(type)) && names_.size() < most_columns;
      if (!is_read) {
        constexpr std::size_t most_listed = 300;
        if (head_.skipped.size() < most_listed)
          head_.skipped += fmt::format("{}{} ({})", head_.skipped.empty() ? "" : ", ", name, type);
      } else if (!is_even_time(name)) {
        take(name, type);
      }
    }
    if (!names_.empty()) return Done{};
    return Error{Errc::too_few_samples,
                 fmt::format("has no column of numbers: it has {}", head_.skipped)};
  }

  /// True for the time of an evenly sampled recording, which only repeats its rate.
  [[nodiscard]] bool is_even_time(std::string_view name) const {
    return name == head_.fact(parquet::time_key) && !head_.fact(parquet::rate_key).empty() &&
           options_.time_channel.empty();
  }

  void take(const std::string& name, const std::string& type) {
    const std::string exact(head_.fact(fmt::format("{}{}", parquet::name_prefix, name)));
    std::string unit(head_.fact(fmt::format("{}{}", parquet::unit_prefix, name)));
    if (is_instant(type)) unit = "ns";
    if (type == "DOUBLE" && name == head_.fact(parquet::time_key)) {
      head_.stamps = names_.size();
      head_.is_since_start = true;
    }
    names_.push_back(sql_name(name));
    head_.columns.push_back({exact.empty() ? name : exact, unit, type});
  }

  /// Exact integers; timestamps in nanoseconds.
  [[nodiscard]] std::string whole(std::size_t column) const {
    return is_instant(head_.columns[column].type) ? fmt::format("epoch_ns({})", names_[column])
                                                  : names_[column];
  }

  /// The first stamp, if stamps are integers with more digits than a double has.
  Status read_origin() {
    if (head_.stamps) return Done{};
    std::vector<std::string> headings;
    for (const Column& column : head_.columns)
      headings.push_back(column.unit.empty() ? column.name
                                             : fmt::format("{} ({})", column.name, column.unit));
    const auto time = time_among(headings, options_);
    if (!time) return Done{};
    const std::string& type = head_.columns[*time].type;
    if (!is_integer(type) && !is_instant(type)) return Done{};
    const auto first =
        pairs(database_, fmt::format("SELECT CAST({0} AS VARCHAR) FROM {1} WHERE {2} IS NOT NULL "
                                     "LIMIT 1",
                                     whole(*time), from_, names_[*time]));
    if (!first) return first.error();
    if (first->empty()) return Done{};
    const std::string& text = first->front()[0];
    std::int64_t origin = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), origin);
    if (error != std::errc() || stop != text.data() + text.size()) return Done{};
    head_.stamps = *time;
    head_.origin = origin;
    return Done{};
  }

  [[nodiscard]] std::string selection() const {
    std::string sql = "SELECT ";
    for (std::size_t c = 0; c < names_.size(); ++c) {
      const bool is_less = head_.stamps == c && !head_.is_since_start;
      const std::string figures =
          is_less ? fmt::format("CAST({} AS HUGEINT) - ({})", whole(c), head_.origin) : whole(c);
      sql += fmt::format("{}CAST({} AS DOUBLE)", c == 0 ? "" : ", ", figures);
    }
    return sql + " FROM " + from_;
  }

  Status read_rows(const ByteSink& sink) {
    auto queried = database_.query(selection());
    if (!queried) return queried.error();
    DuckdbRows rows = std::move(queried).value();
    const std::size_t width = names_.size();
    const std::size_t most = most_frame_bytes / sizeof(double) / width;
    std::vector<double> chunk;
    for (;;) {
      const auto count = rows.next();
      if (!count) return count.error();
      if (*count == 0) return Done{};
      chunk.resize(*count);
      block_.resize(*count * width);
      // A chunk has 2048 rows: one too large for a frame is split.
      for (std::size_t row = 0; row < *count; row += most) {
        const std::size_t some = std::min(most, *count - row);
        for (std::size_t c = 0; c < width; ++c) {
          rows.copy(c, chunk);
          std::copy_n(chunk.begin() + static_cast<std::ptrdiff_t>(row), some,
                      block_.begin() + static_cast<std::ptrdiff_t>(c * some));
        }
        const auto bytes = std::as_bytes(std::span(block_).first(some * width));
        if (!sink({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) return nobody();
      }
    }
  }

  Duckdb database_;
  std::string from_;
  std::string path_;  ///< quoted for SQL
  const ReadOptions& options_;
  Head head_;
  std::vector<std::string> names_;  ///< names of the columns that are read, quoted for SQL
  std::vector<double> block_;
};

}  // namespace

Status read_values(const std::string& path, const ReadOptions& options, const ByteSink& sink) {
  auto opened = Duckdb::open(options.duckdb_library, "");
  if (!opened) return opened.error();
  Reading reading(std::move(opened).value(), path, options);
  const Status done = reading.run(sink);
  if (done) return done;
  std::string message = done.error().message;
  for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path))
    message.replace(at, path.size(), "it");
  if (done.error().code == Errc::corrupt) message = "is damaged, or breaks off: " + message;
  return Error{done.error().code, message};
}

}  // namespace proofmass::io::parquet
