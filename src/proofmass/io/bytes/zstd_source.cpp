#include <array>
#include <string>
#include <zstd.h>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/bytes/byte_source.hpp"

namespace proofmass::io {
namespace {

class ZstdSource final : public ByteSource {
 public:
  explicit ZstdSource(std::unique_ptr<ByteSource> source)
      : source_(std::move(source)), context_(ZSTD_createDCtx()) {
    PM_EXPECTS(context_ != nullptr);
  }
  ~ZstdSource() override { ZSTD_freeDCtx(context_); }

  Result<std::size_t> read(std::span<char> into) override {
    ZSTD_outBuffer out{into.data(), into.size(), 0};
    while (out.pos == 0 && !ended_ && !into.empty()) {
      if (in_.pos == in_.size && !at_end_ && !is_full_)
        if (const Status refilled = refill(); !refilled) return refilled.error();
      step(out);
    }
    produced_ += out.pos;
    if (out.pos == 0 && produced_ == 0 && !note_.empty()) return Error{Errc::corrupt, note_};
    return out.pos;
  }
  [[nodiscard]] double fraction_read() const override { return source_->fraction_read(); }
  [[nodiscard]] std::vector<Note> notes() const override {
    if (note_.empty()) return {};
    return {{Severity::bad, note_ + "; what was read before is kept"}};
  }

 private:
  Status refill() {
    const auto count = source_->read(compressed_);
    if (!count) return count.error();
    consumed_ += *count;
    in_ = {compressed_.data(), *count, 0};
    at_end_ = *count == 0;
    return Done{};
  }

  void step(ZSTD_outBuffer& out) {
    if (at_end_ && !is_full_) {
      ended_ = true;
      if (inside_frame_) note_ = "the zstd data break off after byte " + std::to_string(consumed_);
      return;
    }
    const std::size_t outcome = ZSTD_decompressStream(context_, &out, &in_);
    if (ZSTD_isError(outcome) != 0u) {
      ended_ = true;
      note_ = "the zstd data are damaged near byte " +
              std::to_string(consumed_ - in_.size + in_.pos) + " (" + ZSTD_getErrorName(outcome) +
              ")";
      return;
    }
    inside_frame_ = outcome != 0;
    // Data that did not fit are buffered in the library and need no further input.
    is_full_ = out.pos == out.size && inside_frame_;
  }

  std::unique_ptr<ByteSource> source_;
  ZSTD_DCtx* context_;  ///< for windows up to 128 MiB, the library's own limit
  std::array<char, 1 << 16> compressed_{};
  ZSTD_inBuffer in_{nullptr, 0, 0};
  std::uint64_t consumed_ = 0;
  std::uint64_t produced_ = 0;
  bool at_end_ = false;
  bool is_full_ = false;
  bool inside_frame_ = true;
  bool ended_ = false;
  std::string note_;
};

}  // namespace

std::unique_ptr<ByteSource> unzstd(std::unique_ptr<ByteSource> compressed) {
  return std::make_unique<ZstdSource>(std::move(compressed));
}

}  // namespace proofmass::io
