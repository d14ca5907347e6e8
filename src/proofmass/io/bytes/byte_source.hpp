#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// A stream of bytes: a file, memory, or another stream decompressed. Read once, sequentially.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  /// Fills the beginning of `into` and returns the number of bytes; 0 only at the end.
  virtual Result<std::size_t> read(std::span<char> into) = 0;
  /// Total bytes of this stream, if known in advance.
  [[nodiscard]] virtual std::optional<std::uint64_t> size() const { return std::nullopt; }
  /// Descriptor of the regular file that holds exactly these bytes, if there is one: for libraries
  /// that need a file. Open during the lifetime of this object.
  [[nodiscard]] virtual std::optional<int> descriptor() const { return std::nullopt; }
  /// The memory that holds exactly these bytes, if there is one; it outlives this object.
  [[nodiscard]] virtual std::optional<std::span<const std::byte>> memory() const {
    return std::nullopt;
  }
  /// Fraction of the underlying file read, in [0, 1]; 0 if its length is unknown.
  [[nodiscard]] virtual double fraction_read() const = 0;
  /// Faults from which the reader recovered, complete once read() has returned 0.
  [[nodiscard]] virtual std::vector<Note> notes() const { return {}; }
};

/// A stream with look-ahead.
class PeekSource final : public ByteSource {
 public:
  explicit PeekSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

  /// The next bytes, `wanted` of them or all there are, without consuming them.
  Result<std::string_view> peek(std::size_t wanted);
  Result<std::size_t> read(std::span<char> into) override;
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return source_->size(); }
  [[nodiscard]] std::optional<int> descriptor() const override { return source_->descriptor(); }
  [[nodiscard]] std::optional<std::span<const std::byte>> memory() const override {
    return source_->memory();
  }
  [[nodiscard]] double fraction_read() const override { return source_->fraction_read(); }
  [[nodiscard]] std::vector<Note> notes() const override { return source_->notes(); }

 private:
  std::unique_ptr<ByteSource> source_;
  std::string ahead_;
  std::size_t taken_ = 0;  ///< bytes of ahead_ that read() has returned
};

/// `path` "-" is standard input. Errors: unreadable.
[[nodiscard]] Result<std::unique_ptr<ByteSource>> open_file(const std::string& path);
/// The bytes must outlive the source.
[[nodiscard]] std::unique_ptr<ByteSource> open_memory(std::span<const std::byte> bytes);

/// One gzip, xz or zstd file, or several concatenated. Truncated data or a wrong checksum end the
/// stream there, with a note of Severity::bad; if nothing could be read, read() fails as corrupt.
[[nodiscard]] std::unique_ptr<ByteSource> gunzip(std::unique_ptr<ByteSource> compressed);
[[nodiscard]] std::unique_ptr<ByteSource> unxz(std::unique_ptr<ByteSource> compressed);
[[nodiscard]] std::unique_ptr<ByteSource> unzstd(std::unique_ptr<ByteSource> compressed);
/// UTF-16 as UTF-8; a byte-order mark must have been removed.
[[nodiscard]] std::unique_ptr<ByteSource> utf8_from_utf16(std::unique_ptr<ByteSource> source,
                                                          bool big_endian);

/// Removes gzip, xz or zstd compression and UTF-16 encoding, as detected from the first bytes.
[[nodiscard]] Result<std::unique_ptr<PeekSource>> unwrap(std::unique_ptr<ByteSource> source);

}  // namespace proofmass::io
