#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/arrays/figure_type.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"

namespace proofmass::io::wav {

/// Information of a WAV file before and after its samples.
struct Header {
  std::size_t channels = 0;
  std::uint32_t rate_hz = 0;
  FigureType figure;                           ///< type of each sample; 'u' for a byte, 'i', or 'f'
  std::size_t valid_bits = 0;                  ///< for an integer, the highest of its bytes
  std::uint64_t begin = 0;                     ///< offset of the samples
  std::uint64_t bytes = 0;                     ///< size of the samples present
  std::optional<std::uint64_t> claimed_bytes;  ///< if more were claimed
  std::map<std::string, std::string> texts;    ///< LIST INFO by four-letter key: "ICMT"
  std::vector<Note> notes;

  [[nodiscard]] std::size_t row_bytes() const { return channels * figure.bytes; }
  [[nodiscard]] std::uint64_t rows() const { return bytes / row_bytes(); }
};

/// Errors: corrupt (naming the byte), unsupported (compressed audio), unreadable.
[[nodiscard]] Result<Header> read_header(const RandomBytes& file);

}  // namespace proofmass::io::wav
