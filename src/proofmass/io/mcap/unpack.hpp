#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {

/// Chunks with a larger decompressed size are not read.
inline constexpr std::uint64_t most_unpacked = std::uint64_t{1} << 30;

/// Decompresses the records of chunks into a reusable buffer.
class Unpacker {
 public:
  Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  ~Unpacker();

  /// The records before compression (none, lz4, zstd), with their checksum verified. Uncompressed
  /// data are returned directly; otherwise the result is valid until the next call.
  /// Errors: unsupported (another compression), corrupt (damaged; a size other than stated, a wrong
  /// checksum). Never allocates more than the given bytes can decompress to.
  [[nodiscard]] Result<std::string_view> unpack(const ChunkHead& head, std::string_view packed);

 private:
  struct Contexts;

  [[nodiscard]] Result<std::string_view> unzstd(std::size_t unpacked, std::string_view packed);
  [[nodiscard]] Result<std::string_view> unlz4(std::size_t unpacked, std::string_view packed);
  char* room_for(std::size_t bytes);

  std::unique_ptr<Contexts> contexts_;
  std::unique_ptr<char[]> room_;
  std::size_t room_bytes_ = 0;
};

}  // namespace proofmass::io::mcap
