#include <array>
#include <zlib.h>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/bytes/byte_source.hpp"

namespace proofmass::io {
namespace {

class GzipSource final : public ByteSource {
 public:
  explicit GzipSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {
    constexpr int gzip_header_and_largest_window = 16 + MAX_WBITS;
    PM_EXPECTS(inflateInit2(&stream_, gzip_header_and_largest_window) == Z_OK);
  }
  ~GzipSource() override { inflateEnd(&stream_); }

  Result<std::size_t> read(std::span<char> into) override {
    stream_.next_out = reinterpret_cast<Bytef*>(into.data());
    stream_.avail_out = static_cast<uInt>(std::min<std::size_t>(into.size(), 1u << 30));
    const uInt wanted = stream_.avail_out;
    while (stream_.avail_out == wanted && !ended_) {
      if (const Status refilled = refill(); !refilled) return refilled.error();
      if (ended_) break;
      step(inflate(&stream_, Z_NO_FLUSH));
    }
    const std::size_t count = wanted - stream_.avail_out;
    produced_ += count;
    if (count == 0 && produced_ == 0 && !note_.empty()) return Error{Errc::corrupt, note_};
    return count;
  }
  [[nodiscard]] double fraction_read() const override { return source_->fraction_read(); }
  [[nodiscard]] std::vector<Note> notes() const override {
    if (note_.empty()) return {};
    return {{Severity::bad, note_ + "; what was read before is kept"}};
  }

 private:
  Status refill() {
    if (stream_.avail_in > 0) return Done{};
    const auto count = source_->read(compressed_);
    if (!count) return count.error();
    consumed_ += *count;
    stream_.next_in = reinterpret_cast<Bytef*>(compressed_.data());
    stream_.avail_in = static_cast<uInt>(*count);
    if (*count == 0) {
      ended_ = true;
      if (inside_member_) note_ = "the gzip data break off after byte " + std::to_string(consumed_);
    }
    // Several members may be concatenated; anything else after one is padding.
    if (!inside_member_ && !ended_) begin_member();
    return Done{};
  }

  void begin_member() {
    if (*stream_.next_in != 0x1F) {
      ended_ = true;
      return;
    }
    inflateReset(&stream_);
    inside_member_ = true;
  }

  void step(int outcome) {
    if (outcome == Z_STREAM_END) {
      inside_member_ = false;
      if (stream_.avail_in > 0) begin_member();
      return;
    }
    if (outcome == Z_OK || outcome == Z_BUF_ERROR) return;
    ended_ = true;
    note_ = "the gzip data are damaged near byte " + std::to_string(consumed_ - stream_.avail_in) +
            " (" + (stream_.msg != nullptr ? stream_.msg : "zlib says no more") + ")";
  }

  std::unique_ptr<ByteSource> source_;
  z_stream stream_{};
  std::array<char, 1 << 16> compressed_{};
  std::uint64_t consumed_ = 0;
  std::uint64_t produced_ = 0;
  bool inside_member_ = true;
  bool ended_ = false;
  std::string note_;
};

}  // namespace

std::unique_ptr<ByteSource> gunzip(std::unique_ptr<ByteSource> compressed) {
  return std::make_unique<GzipSource>(std::move(compressed));
}

}  // namespace proofmass::io
