#include "proofmass/io/columns.hpp"

#include <algorithm>

namespace proofmass::io {

void GrowingColumn::append(std::span<const double> values) {
  constexpr std::size_t smallest_piece = 4096;
  while (!values.empty()) {
    std::vector<double>& last = pieces_.back();
    const auto part = values.first(std::min(values.size(), last.capacity() - last.size()));
    last.insert(last.end(), part.begin(), part.end());
    size_ += part.size();
    values = values.subspan(part.size());
    if (!values.empty()) pieces_.emplace_back().reserve(std::max(smallest_piece, size_ / 8));
  }
}

std::vector<double> GrowingColumn::take() {
  if (pieces_.size() == 1) return std::move(pieces_.front());
  std::vector<double> all;
  all.reserve(size_);
  for (std::vector<double>& piece : pieces_) {
    all.insert(all.end(), piece.begin(), piece.end());
    std::vector<double>().swap(piece);  // assigning {} would keep its memory
  }
  return all;
}

}  // namespace proofmass::io
