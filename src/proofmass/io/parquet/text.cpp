#include <span>

#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/parquet/duckdb_library.hpp"
#include "proofmass/io/parquet/table.hpp"

namespace proofmass::io::parquet {
namespace {

std::string csv_field(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

bool hand_on(const ByteSink& sink, const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += (line.empty() ? "" : ",") + csv_field(field);
  line += '\n';
  return sink(std::span<const char>(line));
}

Result<std::vector<std::string>> names_in(const Duckdb& database, const std::string& table) {
  auto described = database.query("SELECT column_name FROM (DESCRIBE SELECT * FROM " + table + ")");
  if (!described) return described.error();
  DuckdbRows rows = std::move(described).value();
  std::vector<std::string> names;
  for (;;) {
    const auto count = rows.next();
    if (!count) return count.error();
    if (*count == 0) return names;
    for (std::size_t row = 0; row < *count; ++row) names.push_back(rows.text(0, row));
  }
}

Status send_rows(const Duckdb& database, const std::string& table, const ByteSink& sink) {
  const auto names = names_in(database, table);
  if (!names) return names.error();
  if (!hand_on(sink, *names)) return Done{};
  std::string fields;
  for (const std::string& name : *names)
    fields += (fields.empty() ? "" : ", ") + ("CAST(" + sql_name(name) + " AS VARCHAR)");
  auto queried = database.query("SELECT " + fields + " FROM " + table);
  if (!queried) return queried.error();
  DuckdbRows rows = std::move(queried).value();
  for (;;) {
    const auto count = rows.next();
    if (!count) return count.error();
    if (*count == 0) return Done{};
    for (std::size_t row = 0; row < *count; ++row) {
      std::vector<std::string> line;
      for (std::size_t k = 0; k < names->size(); ++k) line.push_back(rows.text(k, row));
      if (!hand_on(sink, line)) return Done{};
    }
  }
}

}  // namespace

Result<std::string> as_csv(const std::string& path, const std::string& duckdb_library) {
  std::string csv;
  const auto work = [&](const ByteSink& sink) -> Status {
    auto opened = Duckdb::open(duckdb_library, "");
    if (!opened) return opened.error();
    const Duckdb database = std::move(opened).value();
    return send_rows(database, "read_parquet(" + sql_text(path) + ")", sink);
  };
  const auto take = [&](std::span<const char> bytes) -> Status {
    csv.append(bytes.data(), bytes.size());
    return Done{};
  };
  const Status done = run_in_child(work, take, {});
  if (!done) return done.error().at(path);
  return csv;
}

}  // namespace proofmass::io::parquet
