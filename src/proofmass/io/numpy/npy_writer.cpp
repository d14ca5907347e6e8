#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "proofmass/io/bytes/little_endian.hpp"
#include "proofmass/io/reading/recording_writers.hpp"
#include "proofmass/io/time/row_times.hpp"

namespace proofmass::io {
namespace {

/// Its length does not depend on the number of rows, so that it can be overwritten once that is
/// known. The values begin at a multiple of 64 bytes, as the format requires, after a line end.
std::string header_of(std::size_t rows, std::size_t columns) {
  std::string text =
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  constexpr std::size_t magic_bytes = 10;
  constexpr std::size_t all_bytes = 128;
  text.resize(all_bytes - magic_bytes - 1, ' ');
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(text.size() + 1);
  out += '\0';
  return out + text + '\n';
}

class NpyWriter final : public RecordingWriter {
 public:
  NpyWriter(std::unique_ptr<OutputFile> file, const Recording& head)
      : file_(std::move(file)),
        times_(head.time),
        columns_(head.channels.size() + (times_.is_timed() ? 1 : 0)),
        out_(header_of(0, columns_)) {}

  [[nodiscard]] Status write(const Block& block) override {
    for (std::size_t r = 0; r < block.rows(); ++r) {
      if (times_.is_timed()) append_value(out_, times_.at(block, r));
      for (const View<double>& channel : block.channels) append_value(out_, channel[r]);
      if (out_.size() < (1u << 16)) continue;
      if (const Status done = pass_on(); !done) return done;
    }
    rows_ += block.rows();
    return Done{};
  }
  [[nodiscard]] Status finish(const Recording&) override {
    if (const Status done = pass_on(); !done) return done;
    const Status done = file_->overwrite(0, header_of(rows_, columns_));
    return done ? file_->keep() : done;
  }

 private:
  Status pass_on() {
    const Status done = file_->append(out_);
    out_.clear();
    return done;
  }

  std::unique_ptr<OutputFile> file_;
  RowTimes times_;
  std::size_t columns_;
  std::string out_;
  std::size_t rows_ = 0;
};

}  // namespace

Result<std::unique_ptr<RecordingWriter>> create_npy(std::unique_ptr<OutputFile> file,
                                                    const WriterHead& head,
                                                    const WriteOptions&) {
  return std::unique_ptr<RecordingWriter>(
      std::make_unique<NpyWriter>(std::move(file), head.recording));
}

}  // namespace proofmass::io
