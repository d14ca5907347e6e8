#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/index.hpp"

namespace proofmass::io::tdms {

/// Evenly spaced values of one channel in a chunk.
struct Piece {
  std::uint64_t offset = 0;  ///< offset of the first value from the start of the chunk
  std::uint64_t stride = 0;
  std::uint64_t values = 0;
};

/// The part of a chunk that belongs to a channel, or to one of its scalers.
struct Entry {
  std::uint32_t channel = 0;
  std::uint32_t scaler = 0;
  Kind kind = Kind::other;
  std::uint8_t bit = Scaler::no_bit;
  std::uint32_t first_piece = 0;
  std::uint32_t pieces = 0;  ///< 0 if not read
  std::uint64_t values = 0;
};

/// Layout of a chunk.
struct Layout {
  std::vector<Entry> entries;  ///< by channel, then scaler
  std::vector<Piece> pieces;
  std::uint64_t chunk_bytes = 0;
  bool big_endian = false;
  bool is_daqmx = false;
  bool is_contiguous = false;  ///< channel by channel, without text

  /// The entries of one channel.
  [[nodiscard]] std::span<const Entry> of(std::uint32_t channel) const;
  [[nodiscard]] std::size_t size() const { return entries.size() + pieces.size(); }
};

/// A channel with values in a segment.
struct Part {
  std::uint32_t channel = 0;
  const Index* index = nullptr;
};

struct RawDataOrder {
  bool interleaved = false;
  bool big_endian = false;
  std::uint64_t other_bytes = 0;  ///< bytes per value of kind other
};

/// Errors: corrupt, unsupported: a short message without a position.
[[nodiscard]] Result<Layout> lay_out(std::span<const Part> parts, const RawDataOrder& order);

/// The size of a value of unknown kind for which whole chunks fill a segment's data; 0 if none
/// fits.
[[nodiscard]] std::uint64_t infer_other_bytes(std::span<const Part> parts,
                                              std::uint64_t data_bytes);

/// The available part of a chunk that is truncated after `bytes`.
[[nodiscard]] Layout broken_off(const Layout& layout, std::uint64_t bytes);

/// A chunk of `bytes` with the same fraction of every channel's values; nullopt if that is not a
/// whole number of values.
[[nodiscard]] std::optional<Layout> in_proportion(const Layout& layout, std::uint64_t bytes);

}  // namespace proofmass::io::tdms
