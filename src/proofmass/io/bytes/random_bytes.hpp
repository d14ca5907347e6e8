#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"

namespace proofmass::io {

/// A file with random access, valid during the lifetime of this object.
class RandomBytes {
 public:
  RandomBytes() = default;
  RandomBytes(const RandomBytes&) = delete;
  RandomBytes& operator=(const RandomBytes&) = delete;
  virtual ~RandomBytes() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `into` from byte `offset` and returns the number of bytes; fewer than requested only at
  /// the end.
  /// Errors: unreadable.
  [[nodiscard]] virtual Result<std::size_t> read_at(std::uint64_t offset,
                                                    std::span<char> into) const = 0;
  /// Faults found by decompression: truncated data.
  [[nodiscard]] virtual std::vector<Note> notes() const { return {}; }
};

/// Random access to the bytes of a stream: the underlying file; the underlying memory; else
/// (compressed, a pipe) an unnamed file on disk with the decompressed data.
/// Errors: those of the stream; unreadable (no space on the disk).
[[nodiscard]] Result<std::unique_ptr<RandomBytes>> random_bytes_of(
    std::unique_ptr<PeekSource> source, const Progress& progress);

}  // namespace proofmass::io
