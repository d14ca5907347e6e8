#include <array>
#include <utility>
#include <zlib.h>

#include "proofmass/io/bytes/output_file.hpp"

namespace proofmass::io {
namespace {

/// A file whose bytes are compressed as they are written.
class GzipFile final : public OutputFile {
 public:
  explicit GzipFile(std::unique_ptr<OutputFile> file) : file_(std::move(file)) {
    constexpr int gzip_window = 15 + 16;
    constexpr int memory_level = 8;
    is_open_ = deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, memory_level,
                            Z_DEFAULT_STRATEGY) == Z_OK;
  }
  ~GzipFile() override {
    if (is_open_) deflateEnd(&stream_);
  }

  [[nodiscard]] Status append(std::string_view bytes) override {
    size_ += bytes.size();
    return compress(bytes, Z_NO_FLUSH);
  }
  [[nodiscard]] Status overwrite(std::uint64_t, std::string_view) override {
    return Error{Errc::unsupported, "what is compressed cannot be written over"};
  }
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] const std::string& part_path() const override { return file_->part_path(); }
  [[nodiscard]] Status keep() override {
    const Status done = compress({}, Z_FINISH);
    return done ? file_->keep() : done;
  }

 private:
  Status compress(std::string_view bytes, int flush) {
    if (!is_open_) return Error{Errc::unreadable, "no memory to compress with"};
    std::array<char, 1 << 16> packed;
    // zlib guarantees that it does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream_.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream_.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream_, flush);
      const std::size_t count = packed.size() - stream_.avail_out;
      if (count == 0) break;
      if (const Status done = file_->append({packed.data(), count}); !done) return done;
    } while (stream_.avail_out == 0);
    return Done{};
  }

  std::unique_ptr<OutputFile> file_;
  z_stream stream_{};
  bool is_open_ = false;
  std::uint64_t size_ = 0;
};

}  // namespace

std::unique_ptr<OutputFile> gzipped(std::unique_ptr<OutputFile> file) {
  return std::make_unique<GzipFile>(std::move(file));
}

}  // namespace proofmass::io
