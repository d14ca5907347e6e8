#include "proofmass/io/reading/columns.hpp"

#include <algorithm>
#include <cstdint>
#include <sys/mman.h>
#include <utility>

namespace proofmass::io {
namespace {

/// Reserves memory, and requests large pages for large pieces: allocating small ones one by one
/// takes a quarter of the time of reading a table. Only a hint: nothing depends on it.
void reserve(std::vector<double>& piece, std::size_t count) {
  piece.reserve(count);
  constexpr std::uintptr_t large_page = std::uintptr_t{2} << 20;
  const auto begin = reinterpret_cast<std::uintptr_t>(piece.data());
  const std::uintptr_t end = begin + piece.capacity() * sizeof(double);
  const std::uintptr_t first = (begin + large_page - 1) / large_page * large_page;
  const std::uintptr_t last = end / large_page * large_page;
  if (last > first + 2 * large_page)
    ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

}  // namespace

GrowingColumn::GrowingColumn(std::size_t expected) {
  reserve(pieces_.emplace_back(), expected);
}

void GrowingColumn::append(std::span<const double> values) {
  constexpr std::size_t smallest_piece = 4096;
  while (!values.empty()) {
    std::vector<double>& last = pieces_.back();
    const auto part = values.first(std::min(values.size(), last.capacity() - last.size()));
    last.insert(last.end(), part.begin(), part.end());
    size_ += part.size();
    values = values.subspan(part.size());
    if (!values.empty()) reserve(pieces_.emplace_back(), std::max(smallest_piece, size_ / 8));
  }
}

std::vector<double> GrowingColumn::take() {
  if (pieces_.size() == 1) {
    size_ = 0;
    return std::exchange(pieces_.front(), {});
  }
  std::vector<double> all;
  reserve(all, std::exchange(size_, 0));
  for (std::vector<double>& piece : pieces_) {
    all.insert(all.end(), piece.begin(), piece.end());
    std::vector<double>().swap(piece);  // assigning {} would keep its capacity
  }
  pieces_.resize(1);
  return all;
}

}  // namespace proofmass::io
