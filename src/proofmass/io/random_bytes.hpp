#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/byte_source.hpp"

namespace proofmass::io {

/// A file that can be read anywhere, for as long as this lives.
class RandomBytes {
 public:
  RandomBytes() = default;
  RandomBytes(const RandomBytes&) = delete;
  RandomBytes& operator=(const RandomBytes&) = delete;
  virtual ~RandomBytes() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `into` from byte `offset` on and says how many bytes; fewer than asked only at the end.
  /// Errors: unreadable.
  [[nodiscard]] virtual Result<std::size_t> read_at(std::uint64_t offset,
                                                    std::span<char> into) const = 0;
  /// What unpacking found: compressed data that break off.
  [[nodiscard]] virtual std::vector<Note> notes() const { return {}; }
};

/// The bytes of a stream to be read anywhere: of the file that it is; of memory that it is; else
/// (compressed, a pipe) of a nameless file on disk that they are unpacked to.
/// Errors: those of the stream; unreadable (no room on the disk).
[[nodiscard]] Result<std::unique_ptr<RandomBytes>> random_bytes_of(
    std::unique_ptr<PeekSource> source, const Progress& progress);

}  // namespace proofmass::io
