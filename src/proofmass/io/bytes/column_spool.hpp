#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Takes rows and returns them column by column once all are present; data beyond one piece are
/// kept in an unnamed file in the folder of the output file.
class ColumnSpool {
 public:
  /// `beside` is the path of the output file; "-": the system's temporary folder.
  ColumnSpool(std::size_t columns, std::string beside);

  /// Adds a row, one value per column. Errors: unreadable (no space).
  [[nodiscard]] Status add(std::span<const double> row);
  [[nodiscard]] std::size_t rows() const { return spooled_rows_ + rows_here_; }
  /// Returns a column's values, little-endian, in pieces. Errors: those of `take`, unreadable.
  [[nodiscard]] Status give(std::size_t column,
                            const std::function<Status(std::string_view)>& take);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Status spill();
  [[nodiscard]] Error failed() const;

  std::size_t columns_;
  std::string beside_;
  std::size_t rows_a_piece_;
  std::vector<char> piece_;  ///< rows_a_piece_ rows, column by column
  std::size_t rows_here_ = 0;
  std::size_t spooled_rows_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace proofmass::io
