#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace proofmass::io {

/// A column that grows to a length nobody knows beforehand, with little memory besides its values:
/// pieces that are never moved, each an eighth of what there is, joined at the end one by one. A
/// first piece that was guessed right costs no copy; memory reserved but not written costs nothing.
class GrowingColumn {
 public:
  explicit GrowingColumn(std::size_t expected) { pieces_.emplace_back().reserve(expected); }

  void append(std::span<const double> values) {
    while (!values.empty()) {
      std::vector<double>& last = pieces_.back();
      const auto part = values.first(std::min(values.size(), last.capacity() - last.size()));
      last.insert(last.end(), part.begin(), part.end());
      size_ += part.size();
      values = values.subspan(part.size());
      if (!values.empty()) pieces_.emplace_back().reserve(std::max(smallest_piece, size_ / 8));
    }
  }

  /// All values in one; the column is empty afterwards.
  [[nodiscard]] std::vector<double> take() {
    if (pieces_.size() == 1) return std::move(pieces_.front());
    std::vector<double> all;
    all.reserve(size_);
    for (std::vector<double>& piece : pieces_) {
      all.insert(all.end(), piece.begin(), piece.end());
      piece = {};
    }
    return all;
  }

 private:
  static constexpr std::size_t smallest_piece = 4096;
  std::vector<std::vector<double>> pieces_;
  std::size_t size_ = 0;
};

}  // namespace proofmass::io
