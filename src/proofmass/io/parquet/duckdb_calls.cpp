#include "proofmass/io/parquet/duckdb_calls.hpp"

#include <algorithm>
#include <dlfcn.h>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace proofmass::io::parquet {
namespace {

/// Finds the functions; keeps the name of a missing one.
class Finder {
 public:
  explicit Finder(void* library) : library_(library) {}

  template <class Function>
  void find(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(::dlsym(library_, name));
    if (function == nullptr && missing_ == nullptr) missing_ = name;
  }
  /// nullptr if none is missing.
  [[nodiscard]] const char* missing() const { return missing_; }

 private:
  void* library_;
  const char* missing_ = nullptr;
};

const char* find_session(Finder finder, DuckdbCalls& calls) {
  finder.find(calls.create_config, "duckdb_create_config");
  finder.find(calls.set_config, "duckdb_set_config");
  finder.find(calls.destroy_config, "duckdb_destroy_config");
  finder.find(calls.open_ext, "duckdb_open_ext");
  finder.find(calls.close, "duckdb_close");
  finder.find(calls.connect, "duckdb_connect");
  finder.find(calls.disconnect, "duckdb_disconnect");
  finder.find(calls.free, "duckdb_free");
  finder.find(calls.prepare, "duckdb_prepare");
  finder.find(calls.prepare_error, "duckdb_prepare_error");
  finder.find(calls.destroy_prepare, "duckdb_destroy_prepare");
  finder.find(calls.execute_prepared_streaming, "duckdb_execute_prepared_streaming");
  finder.find(calls.destroy_result, "duckdb_destroy_result");
  finder.find(calls.result_error, "duckdb_result_error");
  return finder.missing();
}

const char* find_data(Finder finder, DuckdbCalls& calls) {
  finder.find(calls.column_count, "duckdb_column_count");
  finder.find(calls.column_type, "duckdb_column_type");
  finder.find(calls.fetch_chunk, "duckdb_fetch_chunk");
  finder.find(calls.create_logical_type, "duckdb_create_logical_type");
  finder.find(calls.destroy_logical_type, "duckdb_destroy_logical_type");
  finder.find(calls.create_data_chunk, "duckdb_create_data_chunk");
  finder.find(calls.destroy_data_chunk, "duckdb_destroy_data_chunk");
  finder.find(calls.data_chunk_reset, "duckdb_data_chunk_reset");
  finder.find(calls.data_chunk_get_size, "duckdb_data_chunk_get_size");
  finder.find(calls.data_chunk_set_size, "duckdb_data_chunk_set_size");
  finder.find(calls.data_chunk_get_vector, "duckdb_data_chunk_get_vector");
  finder.find(calls.vector_get_data, "duckdb_vector_get_data");
  finder.find(calls.vector_get_validity, "duckdb_vector_get_validity");
  finder.find(calls.vector_size, "duckdb_vector_size");
  finder.find(calls.appender_create, "duckdb_appender_create");
  finder.find(calls.appender_error, "duckdb_appender_error");
  finder.find(calls.append_data_chunk, "duckdb_append_data_chunk");
  finder.find(calls.appender_close, "duckdb_appender_close");
  finder.find(calls.appender_destroy, "duckdb_appender_destroy");
  return finder.missing();
}

}  // namespace

const char* find_calls(void* library, DuckdbCalls& calls) {
  const char* missing = find_session(Finder(library), calls);
  return missing == nullptr ? find_data(Finder(library), calls) : missing;
}

std::string duckdb_words(const char* words) {
  std::string text = words == nullptr ? "no reason given" : words;
  // The cause follows the consequence.
  constexpr std::string_view consequence = "pending query result\nError: ";
  if (const std::size_t at = text.find(consequence); at != std::string::npos)
    text.erase(0, at + consequence.size());
  text = text.substr(0, std::min(text.find("\n\nLINE "), std::size_t{600}));
  std::ranges::replace_if(text, [](unsigned char c) { return c < 32 || c == 127; }, ' ');
  return text;
}

Error duckdb_error(Errc code, const char* words) {
  return {code, fmt::format("DuckDB says \"{}\"", duckdb_words(words))};
}

}  // namespace proofmass::io::parquet
