#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms_index.hpp"

namespace proofmass::io {

/// Values of one channel that lie at even distances in a chunk.
struct TdmsPiece {
  std::uint64_t offset = 0;  ///< of the first, from the chunk's front
  std::uint64_t stride = 0;
  std::uint64_t values = 0;
};

/// What a chunk holds of a channel, or of one scaler of it.
struct TdmsEntry {
  std::uint32_t channel = 0;
  std::uint32_t scaler = 0;
  TdmsKind kind = TdmsKind::other;
  std::uint8_t bit = TdmsScaler::no_bit;
  std::uint32_t first_piece = 0;
  std::uint32_t pieces = 0;  ///< none for what is not read
  std::uint64_t values = 0;
};

/// Where everything lies in a chunk.
struct TdmsLayout {
  std::vector<TdmsEntry> entries;  ///< by channel, then scaler
  std::vector<TdmsPiece> pieces;
  std::uint64_t chunk_bytes = 0;
  bool big_endian = false;
  bool is_daqmx = false;
  bool is_contiguous = false;  ///< channel after channel, none of them text

  /// The entries of a channel.
  [[nodiscard]] std::span<const TdmsEntry> of(std::uint32_t channel) const;
  [[nodiscard]] std::size_t size() const { return entries.size() + pieces.size(); }
};

/// A channel that has values in a segment.
struct TdmsPart {
  std::uint32_t channel = 0;
  const TdmsIndex* index = nullptr;
};

struct TdmsOrder {
  bool interleaved = false;
  bool big_endian = false;
  std::uint64_t other_bytes = 0;  ///< bytes a value of kind other
};

/// Errors: corrupt, unsupported: in a few words, without a place.
[[nodiscard]] Result<TdmsLayout> lay_out(std::span<const TdmsPart> parts, const TdmsOrder& order);

/// The bytes that a value of a kind not known must have, so that whole chunks fill a segment's
/// data; 0 if none fits.
[[nodiscard]] std::uint64_t infer_other_bytes(std::span<const TdmsPart> parts,
                                              std::uint64_t data_bytes);

/// What there is of a chunk that breaks off after `bytes`.
[[nodiscard]] TdmsLayout broken_off(const TdmsLayout& layout, std::uint64_t bytes);

/// A chunk of `bytes` in which every channel has the same part of its values; nullopt where that
/// would not be whole values.
[[nodiscard]] std::optional<TdmsLayout> in_proportion(const TdmsLayout& layout,
                                                      std::uint64_t bytes);

}  // namespace proofmass::io
