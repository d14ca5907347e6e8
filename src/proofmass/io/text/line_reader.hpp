#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"

namespace proofmass::io {

/// The lines of a text from any byte, one at a time, in little memory.
class LineReader {
 public:
  /// `file` must outlive the reader; a line begins at `offset`, number `number` in the file.
  LineReader(const RandomBytes& file, std::uint64_t offset, std::size_t number);

  /// Advances to the next line; false at the end. Errors: corrupt (a line of more than 1 MiB),
  /// unreadable.
  [[nodiscard]] Result<bool> next();

  /// The line without its LF or CRLF; decimal_padding bytes are readable after it, and the first of
  /// them is not part of a number. Valid until next().
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::uint64_t offset() const { return offset_; }  ///< offset of its first byte
  [[nodiscard]] std::size_t number() const { return number_; }    ///< 1 = first
  [[nodiscard]] bool is_ended() const { return is_ended_; }       ///< by an LF

 private:
  Status refill();

  const RandomBytes& file_;
  std::string buffer_;      ///< a part of the file, plus padding
  std::size_t filled_ = 0;  ///< bytes of the buffer that are from the file
  std::size_t next_ = 0;    ///< position of the next line in the buffer
  std::uint64_t buffer_offset_;
  std::string_view text_;
  std::uint64_t offset_ = 0;
  std::size_t number_;
  bool is_ended_ = false;
};

}  // namespace proofmass::io
