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

/// A stream of bytes: a file, memory, or another stream decompressed. Read once, front to back.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  /// Fills `into` from its front and says how many bytes; 0 only at the end.
  virtual Result<std::size_t> read(std::span<char> into) = 0;
  /// Bytes of this stream in all, where that is known beforehand.
  [[nodiscard]] virtual std::optional<std::uint64_t> size() const { return std::nullopt; }
  /// The regular file that these bytes are, from its front, where they are one as it lies on the
  /// disk: for libraries that want a file. Open as long as this is.
  [[nodiscard]] virtual std::optional<int> descriptor() const { return std::nullopt; }
  /// The memory that these bytes are, from its front, where they are; it outlives this.
  [[nodiscard]] virtual std::optional<std::span<const std::byte>> memory() const {
    return std::nullopt;
  }
  /// How much of the file behind it is read, in [0, 1]; 0 where its length is not known.
  [[nodiscard]] virtual double fraction_read() const = 0;
  /// What went wrong and could be salvaged, complete once read() has returned 0.
  [[nodiscard]] virtual std::vector<Note> notes() const { return {}; }
};

/// A stream whose beginning can be looked at before it is read.
class PeekSource final : public ByteSource {
 public:
  explicit PeekSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {}

  /// The next bytes, `wanted` of them or all there are, without taking them.
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
  std::size_t taken_ = 0;  ///< bytes of ahead_ that read() has handed out
};

/// `path` "-" is standard input. Errors: unreadable.
[[nodiscard]] Result<std::unique_ptr<ByteSource>> open_file(const std::string& path);
/// The bytes must outlive the source.
[[nodiscard]] std::unique_ptr<ByteSource> open_memory(std::span<const std::byte> bytes);

/// One gzip, xz or zstd file, or several one after another. Data that break off or fail their
/// checksum end the stream there, with a note of Severity::bad; if nothing at all could be read,
/// read() fails as corrupt.
[[nodiscard]] std::unique_ptr<ByteSource> gunzip(std::unique_ptr<ByteSource> compressed);
[[nodiscard]] std::unique_ptr<ByteSource> unxz(std::unique_ptr<ByteSource> compressed);
[[nodiscard]] std::unique_ptr<ByteSource> unzstd(std::unique_ptr<ByteSource> compressed);
/// UTF-16 as UTF-8; a byte-order mark must have been taken off.
[[nodiscard]] std::unique_ptr<ByteSource> utf8_from_utf16(std::unique_ptr<ByteSource> source,
                                                          bool big_endian);

/// Whatever stands in front of the content is taken off by what the first bytes say: gzip, xz or
/// zstd compression, UTF-16.
[[nodiscard]] Result<std::unique_ptr<PeekSource>> unwrap(std::unique_ptr<ByteSource> source);

}  // namespace proofmass::io
