#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/numpy/npy_layout.hpp"

namespace proofmass::io {

/// The values of an array, row by row.
class NpyFigures {
 public:
  /// Errors: corrupt, if there is not even one row, or a column is incomplete.
  [[nodiscard]] static Result<NpyFigures> open(std::unique_ptr<RandomBytes> bytes,
                                               NpyLayout layout);

  /// The next rows, column by column; 0 only at the end. Errors: unreadable.
  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into);

  [[nodiscard]] const NpyLayout& layout() const { return layout_; }
  /// Number of rows in the available bytes, at most as many as the header claims.
  [[nodiscard]] std::size_t rows_there() const;
  [[nodiscard]] std::size_t rows_read() const { return rows_read_; }
  /// Faults found, once read() has returned 0: a truncated array.
  [[nodiscard]] std::vector<Note> notes() const;

 private:
  NpyFigures(std::unique_ptr<RandomBytes> bytes, NpyLayout layout)
      : bytes_(std::move(bytes)), layout_(std::move(layout)) {}
  [[nodiscard]] Result<std::size_t> read_rows(std::span<const std::span<double>> into,
                                              std::size_t rows);
  [[nodiscard]] Result<std::size_t> read_columns(std::span<const std::span<double>> into,
                                                 std::size_t rows);

  std::unique_ptr<RandomBytes> bytes_;
  NpyLayout layout_;
  std::size_t rows_read_ = 0;
  bool is_ended_ = false;
  std::vector<char> piece_;
};

/// The bytes of a stream that are requested in ascending order only: no need to decompress a zip
/// entry to the disk.
[[nodiscard]] std::unique_ptr<RandomBytes> ascending_bytes_of(std::unique_ptr<PeekSource> source);

}  // namespace proofmass::io
