#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Where in a MAT file a variable lies.
struct MatRegion {
  std::size_t offset = 0;
  std::size_t size = 0;
  bool is_packed = false;  ///< by zlib; else as it is
};

/// The bytes of one variable from front to back, unpacked as they are asked for.
class MatStream {
 public:
  /// `file` must outlive the stream. Precondition: the region lies within it.
  MatStream(std::string_view file, const MatRegion& region);
  MatStream(const MatStream&) = delete;
  MatStream& operator=(const MatStream&) = delete;
  ~MatStream();

  /// Fills `into`, all of it. Errors: corrupt (the bytes end before, or cannot be unpacked).
  Status read(std::span<char> into);
  /// Errors: as read().
  Status skip(std::uint64_t count);
  /// When all has been read: whether what was compressed ends here, and has its checksum.
  Status finish();

  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// More than the variable can hold: its bytes, or what zlib can make of them at most.
  [[nodiscard]] std::uint64_t most() const;
  /// An error at a position: "byte 136: …", "byte 136, unpacked byte 40: …".
  [[nodiscard]] Error corrupt(std::uint64_t position, std::string_view what) const;

 private:
  struct Inflater;

  std::string_view bytes_;
  MatRegion region_;
  std::uint64_t position_ = 0;
  std::unique_ptr<Inflater> inflater_;
};

}  // namespace proofmass::io
