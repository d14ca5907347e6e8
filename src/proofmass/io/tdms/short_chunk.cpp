// Incomplete chunks: at the end of a segment, or of a truncated file.
#include <algorithm>
#include <optional>

#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/tdms/layout.hpp"

namespace proofmass::io::tdms {

Layout broken_off(const Layout& layout, std::uint64_t bytes) {
  Layout out = layout;
  out.chunk_bytes = bytes;
  for (Entry& entry : out.entries) {
    if (entry.pieces == 0) continue;
    entry.values = 0;
    for (std::uint32_t p = 0; p < entry.pieces; ++p) {
      Piece& piece = out.pieces[entry.first_piece + p];
      const std::uint64_t size = bytes_per_value(entry.kind);
      const std::uint64_t whole = bytes < piece.offset || bytes - piece.offset < size
                                      ? 0
                                      : (bytes - piece.offset - size) / piece.stride + 1;
      piece.values = std::min(piece.values, whole);
      entry.values += piece.values;
    }
  }
  return out;
}

std::optional<Layout> in_proportion(const Layout& layout, std::uint64_t bytes) {
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 62;
  if (!layout.is_contiguous || layout.chunk_bytes > most_bytes || bytes > most_bytes)
    return std::nullopt;
  Layout out = layout;
  out.chunk_bytes = bytes;
  const auto shorten = [&](std::uint64_t& figure) {
    const Int128 product = Int128{figure} * static_cast<Int128>(bytes);
    figure = static_cast<std::uint64_t>(product / static_cast<Int128>(layout.chunk_bytes));
    return product % static_cast<Int128>(layout.chunk_bytes) == 0;
  };
  bool whole = true;
  for (Entry& entry : out.entries) whole = shorten(entry.values) && whole;
  for (Piece& piece : out.pieces) whole = shorten(piece.values) && shorten(piece.offset) && whole;
  return whole ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace proofmass::io::tdms
