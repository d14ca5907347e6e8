#pragma once

#include <cstdint>
#include <string>

#include "proofmass/core/result.hpp"

// Functions used of DuckDB's C library. Source: DuckDB, "C API", version 1.1.
namespace proofmass::io::parquet {

/// duckdb_result, which is passed by value.
struct DuckdbResult {
  std::uint64_t deprecated_column_count = 0;
  std::uint64_t deprecated_row_count = 0;
  std::uint64_t deprecated_rows_changed = 0;
  void* deprecated_columns = nullptr;
  char* deprecated_error_message = nullptr;
  void* internal_data = nullptr;
};

/// duckdb_string_t: a short text is stored inline.
struct DuckdbText {
  std::uint32_t length;
  char prefix[4];
  union {
    char within[8];
    const char* beyond;
  } rest;
};

inline constexpr int duckdb_done = 0;           ///< duckdb_state DuckDBSuccess
inline constexpr int duckdb_type_double = 11;   ///< duckdb_type DUCKDB_TYPE_DOUBLE
inline constexpr int duckdb_type_varchar = 17;  ///< DUCKDB_TYPE_VARCHAR
inline constexpr int duckdb_type_blob = 18;     ///< DUCKDB_TYPE_BLOB

/// The functions by their names, without "duckdb_"; all opaque handles are pointers.
struct DuckdbCalls {
  int (*create_config)(void** config) = nullptr;
  int (*set_config)(void* config, const char* name, const char* value) = nullptr;
  void (*destroy_config)(void** config) = nullptr;
  int (*open_ext)(const char* path, void** database, void* config, char** error) = nullptr;
  void (*close)(void** database) = nullptr;
  int (*connect)(void* database, void** connection) = nullptr;
  void (*disconnect)(void** connection) = nullptr;
  void (*free)(void* memory) = nullptr;
  int (*prepare)(void* connection, const char* sql, void** statement) = nullptr;
  const char* (*prepare_error)(void* statement) = nullptr;
  void (*destroy_prepare)(void** statement) = nullptr;
  int (*execute_prepared_streaming)(void* statement, DuckdbResult* result) = nullptr;
  void (*destroy_result)(DuckdbResult* result) = nullptr;
  const char* (*result_error)(DuckdbResult* result) = nullptr;
  std::uint64_t (*column_count)(DuckdbResult* result) = nullptr;
  int (*column_type)(DuckdbResult* result, std::uint64_t column) = nullptr;
  void* (*fetch_chunk)(DuckdbResult result) = nullptr;
  void* (*create_logical_type)(int type) = nullptr;
  void (*destroy_logical_type)(void** type) = nullptr;
  void* (*create_data_chunk)(void** types, std::uint64_t columns) = nullptr;
  void (*destroy_data_chunk)(void** chunk) = nullptr;
  void (*data_chunk_reset)(void* chunk) = nullptr;
  std::uint64_t (*data_chunk_get_size)(void* chunk) = nullptr;
  void (*data_chunk_set_size)(void* chunk, std::uint64_t rows) = nullptr;
  void* (*data_chunk_get_vector)(void* chunk, std::uint64_t column) = nullptr;
  void* (*vector_get_data)(void* vector) = nullptr;
  std::uint64_t* (*vector_get_validity)(void* vector) = nullptr;
  std::uint64_t (*vector_size)() = nullptr;
  int (*appender_create)(void* connection,
                         const char* schema,
                         const char* table,
                         void** appender) = nullptr;
  const char* (*appender_error)(void* appender) = nullptr;
  int (*append_data_chunk)(void* appender, void* chunk) = nullptr;
  int (*appender_close)(void* appender) = nullptr;
  int (*appender_destroy)(void** appender) = nullptr;
};

/// Finds them in a library; returns the name of a missing one, or nullptr.
[[nodiscard]] const char* find_calls(void* library, DuckdbCalls& calls);

/// The library's message on one line, without the pointer into the query.
[[nodiscard]] std::string duckdb_words(const char* words);
[[nodiscard]] Error duckdb_error(Errc code, const char* words);

}  // namespace proofmass::io::parquet
