#include "proofmass/io/matlab/mat_stream.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <zlib.h>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::matlab {

struct Stream::Inflater {
  explicit Inflater(std::string_view packed) : rest(packed) {
    PM_EXPECTS(inflateInit(&stream) == Z_OK);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream); }

  /// Decompresses until `into` is full; less if the data end or are damaged.
  std::size_t read(std::span<char> into) {
    constexpr std::size_t at_once = std::size_t{1} << 30;
    std::size_t filled = 0;
    while (filled < into.size() && !ended) {
      if (stream.avail_in == 0) feed(std::min(rest.size(), at_once));
      const auto wanted = static_cast<uInt>(std::min(into.size() - filled, at_once));
      stream.next_out = reinterpret_cast<Bytef*>(into.data() + filled);
      stream.avail_out = wanted;
      const int outcome = inflate(&stream, Z_NO_FLUSH);
      filled += wanted - stream.avail_out;
      const bool is_dry = stream.avail_in == 0 && rest.empty() && stream.avail_out > 0;
      complete = outcome == Z_STREAM_END;
      ended = outcome != Z_OK || is_dry;
    }
    return filled;
  }

  void feed(std::size_t count) {
    // zlib takes a non-const pointer, but never writes to it.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));
    stream.avail_in = static_cast<uInt>(count);
    rest.remove_prefix(count);
  }

  z_stream stream{};
  std::string_view rest;
  bool ended = false;
  bool complete = false;  ///< ended with a valid checksum
};

Stream::Stream(std::string_view file, const Region& region)
    : bytes_(file.substr(region.offset, region.size)), region_(region) {
  PM_EXPECTS(bytes_.size() == region.size);
  if (region.is_packed) inflater_ = std::make_unique<Inflater>(bytes_);
}

Stream::~Stream() = default;

Status Stream::read(std::span<char> into) {
  std::size_t count = 0;
  if (inflater_) {
    count = inflater_->read(into);
  } else {
    count =
        static_cast<std::size_t>(std::min<std::uint64_t>(into.size(), bytes_.size() - position_));
    if (count > 0) std::memcpy(into.data(), bytes_.data() + position_, count);
  }
  position_ += count;
  if (count == into.size()) return Done{};
  return corrupt(position_, inflater_ && !inflater_->complete
                                ? "the variable's compressed data are damaged"
                                : "the variable breaks off");
}

Status Stream::skip(std::uint64_t count) {
  if (!inflater_ && count <= bytes_.size() - position_) {
    position_ += count;
    return Done{};
  }
  std::array<char, 1 << 14> ignored;
  while (count > 0) {
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(count, ignored.size()));
    if (const Status read_piece = read(std::span(ignored).first(piece)); !read_piece)
      return read_piece;
    count -= piece;
  }
  return Done{};
}

Status Stream::finish() {
  if (!inflater_) return Done{};
  std::array<char, 1> beyond;
  inflater_->read(beyond);
  if (inflater_->complete) return Done{};
  return corrupt(position_, "the variable's compressed data are damaged, or continue after it");
}

std::uint64_t Stream::most() const {
  // Source: zlib's technical details, "Maximum Compression Factor": 1032 to 1.
  return inflater_ ? std::uint64_t{bytes_.size()} * 1032 + 64 : bytes_.size();
}

Error Stream::corrupt(std::uint64_t position, std::string_view what) const {
  if (!inflater_)
    return {Errc::corrupt, fmt::format("byte {}: {}", region_.offset + position, what)};
  return {Errc::corrupt,
          fmt::format("byte {}, unpacked byte {}: {}", region_.offset, position, what)};
}

}  // namespace proofmass::io::matlab
