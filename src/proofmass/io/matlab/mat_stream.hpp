#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::io::matlab {

/// Location of a variable in a MAT file.
struct Region {
  std::size_t offset = 0;
  std::size_t size = 0;
  bool is_packed = false;  ///< by zlib; else uncompressed
};

/// The bytes of one variable, sequentially, decompressed on demand.
class Stream {
 public:
  /// `file` must outlive the stream. Precondition: the region lies within it.
  Stream(std::string_view file, const Region& region);
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream();

  /// Fills all of `into`. Errors: corrupt (premature end, or cannot be decompressed).
  Status read(std::span<char> into);
  /// Errors: as read().
  Status skip(std::uint64_t count);
  /// After all has been read: checks that compressed data end here, with a valid checksum.
  Status finish();

  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Upper bound of the variable's size: its bytes, or the maximum zlib can expand them to.
  [[nodiscard]] std::uint64_t most() const;
  /// An error at a position: "byte 136: …", "byte 136, unpacked byte 40: …".
  [[nodiscard]] Error corrupt(std::uint64_t position, std::string_view what) const;

 private:
  struct Inflater;

  std::string_view bytes_;
  Region region_;
  std::uint64_t position_ = 0;
  std::unique_ptr<Inflater> inflater_;
};

}  // namespace proofmass::io::matlab
