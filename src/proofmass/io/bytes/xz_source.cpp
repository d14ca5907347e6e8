#include <array>
#include <lzma.h>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/bytes/byte_source.hpp"

namespace proofmass::io {
namespace {

const char* meaning_of(lzma_ret outcome) {
  switch (outcome) {
    case LZMA_MEM_ERROR:
    case LZMA_MEMLIMIT_ERROR:
      return "it asks for more than 1 GiB of memory";
    case LZMA_FORMAT_ERROR:
      return "not the xz format";
    case LZMA_OPTIONS_ERROR:
      return "made with options that are not supported";
    default:
      return "corrupt";
  }
}

class XzSource final : public ByteSource {
 public:
  explicit XzSource(std::unique_ptr<ByteSource> source) : source_(std::move(source)) {
    constexpr std::uint64_t memory_limit = std::uint64_t{1} << 30;
    PM_EXPECTS(lzma_stream_decoder(&stream_, memory_limit, LZMA_CONCATENATED) == LZMA_OK);
  }
  ~XzSource() override { lzma_end(&stream_); }

  Result<std::size_t> read(std::span<char> into) override {
    stream_.next_out = reinterpret_cast<std::uint8_t*>(into.data());
    stream_.avail_out = into.size();
    while (stream_.avail_out == into.size() && !ended_) {
      if (stream_.avail_in == 0 && !at_end_) {
        const auto count = source_->read(compressed_);
        if (!count) return count.error();
        stream_.next_in = reinterpret_cast<const std::uint8_t*>(compressed_.data());
        stream_.avail_in = *count;
        at_end_ = *count == 0;
      }
      step(lzma_code(&stream_, at_end_ ? LZMA_FINISH : LZMA_RUN));
    }
    const std::size_t count = into.size() - stream_.avail_out;
    if (count == 0 && stream_.total_out == 0 && !note_.empty()) return Error{Errc::corrupt, note_};
    return count;
  }
  [[nodiscard]] double fraction_read() const override { return source_->fraction_read(); }
  [[nodiscard]] std::vector<Note> notes() const override {
    if (note_.empty()) return {};
    return {{Severity::bad, note_ + "; what was read before is kept"}};
  }

 private:
  void step(lzma_ret outcome) {
    if (outcome == LZMA_OK) return;
    ended_ = true;
    if (outcome == LZMA_STREAM_END) return;
    const std::string place = std::to_string(stream_.total_in);
    note_ = outcome == LZMA_BUF_ERROR
                ? "the xz data break off after byte " + place
                : "the xz data are damaged near byte " + place + " (" + meaning_of(outcome) + ")";
  }

  std::unique_ptr<ByteSource> source_;
  lzma_stream stream_ = LZMA_STREAM_INIT;
  std::array<char, 1 << 16> compressed_{};
  bool at_end_ = false;
  bool ended_ = false;
  std::string note_;
};

}  // namespace

std::unique_ptr<ByteSource> unxz(std::unique_ptr<ByteSource> compressed) {
  return std::make_unique<XzSource>(std::move(compressed));
}

}  // namespace proofmass::io
