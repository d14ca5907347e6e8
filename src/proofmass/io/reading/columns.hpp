#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace proofmass::io {

/// A column of unknown final length, with little memory besides its values: pieces that are never
/// moved, each an eighth of the current size, joined at the end one by one. If the length was
/// predicted correctly there is no copy; memory reserved but not written costs nothing.
class GrowingColumn {
 public:
  explicit GrowingColumn(std::size_t expected);

  void append(std::span<const double> values);
  /// All values in one vector; the column is empty afterwards, without an expected length.
  [[nodiscard]] std::vector<double> take();

 private:
  std::vector<std::vector<double>> pieces_;
  std::size_t size_ = 0;
};

}  // namespace proofmass::io
