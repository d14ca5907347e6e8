#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace proofmass::io {

/// A column that grows to a length nobody knows beforehand, with little memory besides its values:
/// pieces that are never moved, each an eighth of what there is, joined at the end one by one. A
/// length that was foreseen costs no copy; memory reserved but not written costs nothing.
class GrowingColumn {
 public:
  explicit GrowingColumn(std::size_t expected);

  void append(std::span<const double> values);
  /// All values in one; the column is empty afterwards, of no expected length.
  [[nodiscard]] std::vector<double> take();

 private:
  std::vector<std::vector<double>> pieces_;
  std::size_t size_ = 0;
};

}  // namespace proofmass::io
