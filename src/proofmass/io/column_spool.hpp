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

/// Takes rows as they come and gives them back column by column, when all are there: what is more
/// than a piece lies meanwhile in a nameless file in the folder of what is being written.
class ColumnSpool {
 public:
  /// `beside` is the path of the file that is being written; "-": the system's temporary folder.
  ColumnSpool(std::size_t columns, std::string beside);

  /// A row's figures, as many as columns. Errors: unreadable (no room).
  [[nodiscard]] Status add(std::span<const double> row);
  [[nodiscard]] std::size_t rows() const { return spooled_rows_ + rows_here_; }
  /// Gives a column's figures, little-endian, in pieces. Errors: those of `take`, unreadable.
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
  std::vector<char> piece_;  ///< of rows_a_piece_ rows, column after column
  std::size_t rows_here_ = 0;
  std::size_t spooled_rows_ = 0;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace proofmass::io
