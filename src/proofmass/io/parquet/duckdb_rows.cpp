#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/parquet/duckdb_calls.hpp"
#include "proofmass/io/parquet/duckdb_library.hpp"

namespace proofmass::io::parquet {
namespace {

bool is_there(const std::uint64_t* validity, std::size_t row) {
  return validity == nullptr || (validity[row / 64] >> (row % 64) & 1) != 0;
}

}  // namespace

DuckdbRows::DuckdbRows(const DuckdbCalls& calls, std::unique_ptr<DuckdbResult> result)
    : calls_(&calls), result_(std::move(result)) {}
DuckdbRows::DuckdbRows(DuckdbRows&& other) noexcept
    : calls_(other.calls_),
      result_(std::move(other.result_)),
      chunk_(std::exchange(other.chunk_, nullptr)) {}
DuckdbRows& DuckdbRows::operator=(DuckdbRows&& other) noexcept {
  std::swap(calls_, other.calls_);
  std::swap(result_, other.result_);
  std::swap(chunk_, other.chunk_);
  return *this;
}
DuckdbRows::~DuckdbRows() {
  if (chunk_ != nullptr) calls_->destroy_data_chunk(&chunk_);
  if (result_) calls_->destroy_result(result_.get());
}

Result<std::size_t> DuckdbRows::next() {
  if (chunk_ != nullptr) calls_->destroy_data_chunk(&chunk_);
  chunk_ = calls_->fetch_chunk(*result_);
  if (chunk_ != nullptr) return static_cast<std::size_t>(calls_->data_chunk_get_size(chunk_));
  const char* error = calls_->result_error(result_.get());
  if (error != nullptr && *error != '\0') return duckdb_error(Errc::corrupt, error);
  return std::size_t{0};
}

std::size_t DuckdbRows::columns() const {
  return static_cast<std::size_t>(calls_->column_count(result_.get()));
}

void DuckdbRows::copy(std::size_t column, std::span<double> into) const {
  PM_EXPECTS(calls_->column_type(result_.get(), column) == duckdb_type_double);
  void* vector = calls_->data_chunk_get_vector(chunk_, column);
  std::memcpy(into.data(), calls_->vector_get_data(vector), into.size_bytes());
  const std::uint64_t* validity = calls_->vector_get_validity(vector);
  if (validity == nullptr) return;
  for (std::size_t row = 0; row < into.size(); ++row)
    if (!is_there(validity, row)) into[row] = std::numeric_limits<double>::quiet_NaN();
}

std::string DuckdbRows::text(std::size_t column, std::size_t row) const {
  const int type = calls_->column_type(result_.get(), column);
  PM_EXPECTS(type == duckdb_type_varchar || type == duckdb_type_blob);
  void* vector = calls_->data_chunk_get_vector(chunk_, column);
  if (!is_there(calls_->vector_get_validity(vector), row)) return {};
  const DuckdbText& text = static_cast<const DuckdbText*>(calls_->vector_get_data(vector))[row];
  constexpr std::uint32_t most_within = 12;
  const char* from = text.length <= most_within ? text.prefix : text.rest.beyond;
  return {from, text.length};
}

DuckdbAppender::DuckdbAppender(const DuckdbCalls& calls, void* appender, std::size_t columns)
    : calls_(&calls), appender_(appender), columns_(columns) {
  void* type = calls.create_logical_type(duckdb_type_double);
  std::vector<void*> types(columns, type);
  chunk_ = calls.create_data_chunk(types.data(), columns);
  calls.destroy_logical_type(&type);
}
DuckdbAppender::DuckdbAppender(DuckdbAppender&& other) noexcept
    : calls_(other.calls_),
      appender_(std::exchange(other.appender_, nullptr)),
      chunk_(std::exchange(other.chunk_, nullptr)),
      columns_(other.columns_) {}
DuckdbAppender::~DuckdbAppender() {
  if (chunk_ != nullptr) calls_->destroy_data_chunk(&chunk_);
  if (appender_ != nullptr) calls_->appender_destroy(&appender_);
}

Status DuckdbAppender::append(std::span<const std::span<const double>> columns) {
  PM_EXPECTS(columns.size() == columns_);
  const std::size_t rows = columns.front().size();
  const auto most = static_cast<std::size_t>(calls_->vector_size());
  for (std::size_t row = 0; row < rows; row += most) {
    const std::size_t count = std::min(most, rows - row);
    calls_->data_chunk_reset(chunk_);
    for (std::size_t c = 0; c < columns_; ++c)
      std::memcpy(calls_->vector_get_data(calls_->data_chunk_get_vector(chunk_, c)),
                  columns[c].subspan(row, count).data(), count * sizeof(double));
    calls_->data_chunk_set_size(chunk_, count);
    if (calls_->append_data_chunk(appender_, chunk_) != duckdb_done) return failed();
  }
  return Done{};
}

Status DuckdbAppender::close() {
  return calls_->appender_close(appender_) == duckdb_done ? Status(Done{}) : failed();
}

Error DuckdbAppender::failed() const {
  return duckdb_error(Errc::unreadable, calls_->appender_error(appender_));
}

}  // namespace proofmass::io::parquet
