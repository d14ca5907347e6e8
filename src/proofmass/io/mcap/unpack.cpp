#include "proofmass/io/mcap/unpack.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/bytes/crc32.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {

struct Unpacker::Contexts {
  ZSTD_DCtx* zstd = nullptr;
  LZ4F_dctx* lz4 = nullptr;
};

Unpacker::Unpacker() : contexts_(std::make_unique<Contexts>()) {}

Unpacker::~Unpacker() {
  ZSTD_freeDCtx(contexts_->zstd);
  LZ4F_freeDecompressionContext(contexts_->lz4);
}

char* Unpacker::room_for(std::size_t bytes) {
  if (bytes > room_bytes_) {
    // Not initialised: pages without decompressed data are never allocated.
    room_ = std::make_unique_for_overwrite<char[]>(bytes);
    room_bytes_ = bytes;
  }
  return room_.get();
}

Result<std::string_view> Unpacker::unzstd(std::size_t unpacked, std::string_view packed) {
  if (contexts_->zstd == nullptr) contexts_->zstd = ZSTD_createDCtx();
  PM_EXPECTS(contexts_->zstd != nullptr);
  char* room = room_for(unpacked);
  const std::size_t count =
      ZSTD_decompressDCtx(contexts_->zstd, room, unpacked, packed.data(), packed.size());
  if (ZSTD_isError(count) != 0u)
    return Error{Errc::corrupt,
                 fmt::format("its zstd data are damaged ({})", ZSTD_getErrorName(count))};
  return std::string_view(room, count);
}

Result<std::string_view> Unpacker::unlz4(std::size_t unpacked, std::string_view packed) {
  if (contexts_->lz4 == nullptr)
    PM_EXPECTS(LZ4F_isError(LZ4F_createDecompressionContext(&contexts_->lz4, LZ4F_VERSION)) == 0u);
  LZ4F_resetDecompressionContext(contexts_->lz4);
  char* room = room_for(unpacked);
  std::size_t filled = 0;
  std::size_t taken = 0;
  std::size_t wanted = 1;
  while (wanted != 0 && taken < packed.size()) {
    std::size_t out = unpacked - filled;
    std::size_t in = packed.size() - taken;
    wanted =
        LZ4F_decompress(contexts_->lz4, room + filled, &out, packed.data() + taken, &in, nullptr);
    if (LZ4F_isError(wanted) != 0u)
      return Error{Errc::corrupt,
                   fmt::format("its lz4 data are damaged ({})", LZ4F_getErrorName(wanted))};
    filled += out;
    taken += in;
    if (in == 0 && out == 0) break;
  }
  if (wanted != 0) return Error{Errc::corrupt, "its lz4 data break off, or are more than it says"};
  return std::string_view(room, filled);
}

Result<std::string_view> Unpacker::unpack(const ChunkHead& head, std::string_view packed) {
  // A zstd block of 4 bytes expands to at most 128 KiB; lz4 to at most 255 bytes per byte.
  const std::uint64_t most_a_byte = head.compression.empty() ? 1 : std::uint64_t{1} << 15;
  if (head.unpacked_bytes > most_unpacked ||
      head.unpacked_bytes > (packed.size() + 16) * most_a_byte)
    return Error{Errc::corrupt, fmt::format("it says that its {} bytes unpack to {}", packed.size(),
                                            head.unpacked_bytes)};
  const auto unpacked_bytes = static_cast<std::size_t>(head.unpacked_bytes);
  Result<std::string_view> unpacked = packed;
  if (head.compression == "zstd") {
    unpacked = unzstd(unpacked_bytes, packed);
  } else if (head.compression == "lz4") {
    unpacked = unlz4(unpacked_bytes, packed);
  } else if (!head.compression.empty()) {
    return Error{Errc::unsupported, fmt::format("it is compressed by {}, expected zstd or lz4",
                                                shown(head.compression))};
  }
  if (!unpacked) return unpacked;
  if (unpacked->size() != unpacked_bytes)
    return Error{Errc::corrupt, fmt::format("it says that it unpacks to {} bytes, and it are {}",
                                            unpacked_bytes, unpacked->size())};
  if (head.crc != 0 && crc32(0, *unpacked) != head.crc)
    return Error{Errc::corrupt, "its checksum is wrong"};
  return unpacked;
}

}  // namespace proofmass::io::mcap
