#include "proofmass/io/bytes/column_spool.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/unnamed_file.hpp"

namespace proofmass::io {
namespace {

constexpr std::size_t figure_bytes = sizeof(double);

}  // namespace

ColumnSpool::ColumnSpool(std::size_t columns, std::string beside)
    : columns_(columns), beside_(std::move(beside)) {
  PM_EXPECTS(columns > 0);
  constexpr std::size_t piece_bytes = std::size_t{8} << 20;
  rows_a_piece_ = std::max<std::size_t>(piece_bytes / (columns * figure_bytes), 64);
}

Error ColumnSpool::failed() const {
  return system_failure(beside_ + ": cannot be written: no room for its columns");
}

Status ColumnSpool::add(std::span<const double> row) {
  PM_EXPECTS(row.size() == columns_);
  if (rows_here_ == rows_a_piece_)
    if (const Status done = spill(); !done) return done;
  if (piece_.empty()) piece_.resize(columns_ * rows_a_piece_ * figure_bytes);
  for (std::size_t c = 0; c < columns_; ++c) {
    auto bytes = std::bit_cast<std::array<char, figure_bytes>>(row[c]);
    if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
    std::memcpy(piece_.data() + (c * rows_a_piece_ + rows_here_) * figure_bytes, bytes.data(),
                figure_bytes);
  }
  ++rows_here_;
  return Done{};
}

Status ColumnSpool::spill() {
  if (!file_) {
    std::filesystem::path folder = std::filesystem::path(beside_).parent_path();
    if (beside_ == "-") folder = P_tmpdir;
    const int descriptor = unnamed_file(folder.empty() ? "." : folder.string());
    if (descriptor >= 0) file_.reset(::fdopen(descriptor, "w+b"));
    if (!file_) return failed();
  }
  if (std::fwrite(piece_.data(), 1, piece_.size(), file_.get()) != piece_.size()) return failed();
  spooled_rows_ += rows_here_;
  rows_here_ = 0;
  return Done{};
}

Status ColumnSpool::give(std::size_t column, const std::function<Status(std::string_view)>& take) {
  const std::size_t stretch = rows_a_piece_ * figure_bytes;
  std::string bytes(spooled_rows_ > 0 ? stretch : 0, '\0');
  for (std::size_t k = 0; k < spooled_rows_ / rows_a_piece_; ++k) {
    const auto offset = static_cast<off_t>((k * columns_ + column) * stretch);
    const bool read = ::fseeko(file_.get(), offset, SEEK_SET) == 0 &&
                      std::fread(bytes.data(), 1, stretch, file_.get()) == stretch;
    if (!read) return failed();
    if (const Status taken = take(bytes); !taken) return taken;
  }
  if (rows_here_ == 0) return Done{};
  return take({piece_.data() + column * stretch, rows_here_ * figure_bytes});
}

}  // namespace proofmass::io
