#include "proofmass/io/parquet/duckdb_library.hpp"

#include <array>
#include <dlfcn.h>
#include <fmt/format.h>

#include "proofmass/io/parquet/duckdb_calls.hpp"

namespace proofmass::io::parquet {
namespace {

Error no_library(const std::string& library, const std::string& why) {
  return {Errc::unsupported,
          fmt::format("Parquet needs DuckDB's library, which was looked for as {}: {}; get "
                      "libduckdb.so from duckdb.org, or by npm as @duckdb/node-bindings-linux-x64, "
                      "and set PROOFMASS_DUCKDB_LIB to its path",
                      library, why)};
}

std::string quoted(std::string_view text, char quote) {
  std::string out(1, quote);
  for (const char c : text) {
    if (c == '\0') continue;
    if (c == quote) out += quote;
    out += c;
  }
  return out + quote;
}

}  // namespace

Duckdb::Duckdb(std::unique_ptr<DuckdbCalls> calls, void* database, void* connection)
    : calls_(std::move(calls)), database_(database), connection_(connection) {}
Duckdb::Duckdb(Duckdb&& other) noexcept
    : calls_(std::move(other.calls_)),
      database_(std::exchange(other.database_, nullptr)),
      connection_(std::exchange(other.connection_, nullptr)) {}
Duckdb::~Duckdb() {
  if (connection_ != nullptr) calls_->disconnect(&connection_);
  if (database_ != nullptr) calls_->close(&database_);
}

Result<Duckdb> Duckdb::open(const std::string& library, const std::string& database) {
  const std::string name = library.empty() ? "libduckdb.so" : library;
  // Never unloaded, because it may have threads.
  void* loaded = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (loaded == nullptr) return no_library(name, duckdb_words(::dlerror()));
  auto calls = std::make_unique<DuckdbCalls>();
  if (const char* missing = find_calls(loaded, *calls); missing != nullptr)
    return no_library(name, fmt::format("it has no {}", missing));
  void* config = nullptr;
  if (calls->create_config(&config) != duckdb_done) return duckdb_error(Errc::unreadable, nullptr);
  constexpr std::array<std::array<const char*, 2>, 4> settings{
      {{"threads", "1"},
       {"memory_limit", "512MB"},
       {"autoinstall_known_extensions", "false"},
       {"autoload_known_extensions", "false"}}};
  for (const auto& [setting, value] : settings) calls->set_config(config, setting, value);
  void* opened = nullptr;
  void* connection = nullptr;
  char* error = nullptr;
  const int state =
      calls->open_ext(database.empty() ? nullptr : database.c_str(), &opened, config, &error);
  calls->destroy_config(&config);
  if (state != duckdb_done) {
    const Error why = duckdb_error(Errc::unreadable, error);
    calls->free(error);
    return why;
  }
  if (calls->connect(opened, &connection) != duckdb_done) {
    calls->close(&opened);
    return duckdb_error(Errc::unreadable, nullptr);
  }
  return Duckdb(std::move(calls), opened, connection);
}

Result<DuckdbRows> Duckdb::query(const std::string& sql) const {
  void* statement = nullptr;
  auto result = std::make_unique<DuckdbResult>();
  if (calls_->prepare(connection_, sql.c_str(), &statement) != duckdb_done) {
    const Error error = duckdb_error(Errc::corrupt, calls_->prepare_error(statement));
    calls_->destroy_prepare(&statement);
    return error;
  }
  const int state = calls_->execute_prepared_streaming(statement, result.get());
  DuckdbRows rows(*calls_, std::move(result));
  if (state != duckdb_done) {
    const auto none = rows.next();
    calls_->destroy_prepare(&statement);
    return none ? duckdb_error(Errc::corrupt, nullptr) : none.error();
  }
  calls_->destroy_prepare(&statement);
  return rows;
}

Status Duckdb::run(const std::string& sql) const {
  auto queried = query(sql);
  if (!queried) return queried.error();
  DuckdbRows rows = std::move(queried).value();
  for (;;) {
    const auto count = rows.next();
    if (!count) return count.error();
    if (*count == 0) return Done{};
  }
}

Result<DuckdbAppender> Duckdb::append_to(const std::string& table, std::size_t columns) const {
  void* appender = nullptr;
  if (calls_->appender_create(connection_, nullptr, table.c_str(), &appender) != duckdb_done) {
    const Error error = duckdb_error(
        Errc::unreadable, appender == nullptr ? nullptr : calls_->appender_error(appender));
    calls_->appender_destroy(&appender);
    return error;
  }
  return DuckdbAppender(*calls_, appender, columns);
}

std::string sql_text(std::string_view text) {
  return quoted(text, '\'');
}

std::string sql_name(std::string_view name) {
  return quoted(name, '"');
}

}  // namespace proofmass::io::parquet
