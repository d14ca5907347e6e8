#include "proofmass/io/reading/raw_rows.hpp"

#include <utility>
#include <vector>

namespace proofmass::io {

std::size_t rows_of(const RawRows& rows) {
  return rows.channels.empty() ? rows.stamps.size() : rows.channels.front().size();
}

void put_before(const RawRows& from, std::size_t first, RawRows& to) {
  const auto put = [&](const std::vector<double>& tail, std::vector<double>& values) {
    if (tail.size() > first)
      values.insert(values.begin(), tail.begin() + static_cast<std::ptrdiff_t>(first), tail.end());
  };
  if (to.channels.empty()) to.channels.resize(from.channels.size());  // at the end
  for (std::size_t c = 0; c < from.channels.size(); ++c) put(from.channels[c], to.channels[c]);
  put(from.stamps, to.stamps);
}

RawRows joined(std::deque<RawRows> pieces) {
  RawRows all;
  if (pieces.empty()) return all;
  all.channels.resize(pieces.front().channels.size());
  std::size_t rows = 0;
  for (const RawRows& piece : pieces) rows += rows_of(piece);
  const auto take = [&](std::vector<double>& into, auto column_of) {
    into.reserve(rows);
    for (RawRows& piece : pieces) {
      const std::vector<double> values = std::exchange(column_of(piece), {});
      into.insert(into.end(), values.begin(), values.end());
    }
  };
  for (std::size_t c = 0; c < all.channels.size(); ++c)
    take(all.channels[c],
         [c](RawRows& piece) -> std::vector<double>& { return piece.channels[c]; });
  if (!pieces.front().stamps.empty())
    take(all.stamps, [](RawRows& piece) -> std::vector<double>& { return piece.stamps; });
  return all;
}

}  // namespace proofmass::io
