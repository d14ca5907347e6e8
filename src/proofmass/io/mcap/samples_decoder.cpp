#include <algorithm>
#include <fmt/format.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/bytes/little_endian.hpp"
#include "proofmass/io/mcap/decoder.hpp"
#include "proofmass/io/mcap/samples.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {
namespace {

std::string heading_of(const SamplesLayout::Column& column) {
  const bool is_plain = std::ranges::none_of(
      column.name, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  const std::string name = is_plain ? column.name : shown(column.name);
  return column.unit.empty() ? name : fmt::format("{} ({})", name, shown(column.unit));
}

TableHead head_of(const SamplesLayout& layout) {
  TableHead head;
  head.format = "MCAP";
  if (layout.has_stamps) {
    head.headings.emplace_back("time (s)");
    head.stamps = DeclaredStamps{0, *parse_unit("s"), {Int128{layout.start_ns.value_or(0)}, -9}};
  } else {
    head.rate_hz = layout.rate_hz;
    head.start_ns = layout.start_ns;
  }
  for (const SamplesLayout::Column& column : layout.columns)
    head.headings.push_back(heading_of(column));
  head.columns = head.headings.size();
  return head;
}

/// Missing rows of the file become rows of NaN if only the rate gives the times.
class SamplesDecoder final : public Decoder {
 public:
  explicit SamplesDecoder(SamplesLayout layout)
      : layout_(std::move(layout)), head_(head_of(layout_)) {}

  [[nodiscard]] const TableHead& head() const override { return head_; }

  [[nodiscard]] Result<std::size_t> take(const Message& message,
                                         std::uint64_t lost_bytes) override {
    const auto block = read_samples_head(message.data);
    if (!block) return block.error();
    if (block->columns != layout_.columns.size() || block->has_stamps != layout_.has_stamps)
      return Error{Errc::corrupt, fmt::format("has {} columns where the schema has {}",
                                              block->columns, layout_.columns.size())};
    rows_ = block->rows;
    figures_ = message.data.substr(samples_head_bytes);
    missing_ = missing_before(block->first, lost_bytes);
    taken_rows_ += rows_;
    expected_ = block->first + rows_ < block->first ? block->first : block->first + rows_;
    return missing_ + rows_;
  }

  void copy(std::size_t first,
            std::size_t count,
            std::span<const std::span<double>> into,
            std::size_t at) const override {
    if (first < missing_) {
      const std::size_t empty = std::min(count, missing_ - first);
      for (const std::span<double> column : into)
        std::ranges::fill(column.subspan(at, empty), no_value);
      first += empty;
      at += empty;
      count -= empty;
    }
    if (count == 0) return;
    const char* column_bytes = figures_.data() + 8 * (first - missing_);
    for (const std::span<double> column : into) {
      load_doubles(column_bytes, column.subspan(at, count));
      column_bytes += 8 * rows_;
    }
  }

  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes;
    if (gaps_ > 0)
      notes.push_back({Severity::bad,
                       fmt::format("{} samples are missing in the file, the first of them sample "
                                   "{}: {}",
                                   lost_rows_, first_lost_, what_became_of_gaps())});
    if (repeats_ > 0)
      notes.push_back({Severity::warning,
                       fmt::format("{} blocks of samples begin before the end of the one before "
                                   "them: kept in the order of the file",
                                   repeats_)});
    return notes;
  }

 private:
  [[nodiscard]] const char* what_became_of_gaps() const {
    if (layout_.has_stamps) return "the stamps show where";
    return unfilled_ ? "not all of them could be left empty, so that later samples come too early"
                     : "they are left empty";
  }

  /// Rows of NaN before a block; in total no more than the data read or lost can have contained.
  std::size_t missing_before(std::uint64_t first, std::uint64_t lost_bytes) {
    if (first < expected_) ++repeats_;
    if (first <= expected_) return 0;
    const std::uint64_t gap = first - expected_;
    if (gaps_++ == 0) first_lost_ = expected_;
    lost_rows_ = lost_rows_ + gap < lost_rows_ ? ~std::uint64_t{0} : lost_rows_ + gap;
    if (layout_.has_stamps) return 0;
    const std::uint64_t backed = taken_rows_ + lost_bytes / (8 * layout_.columns.size());
    if (filled_ > backed || gap > backed - filled_) {
      unfilled_ = true;
      return 0;
    }
    filled_ += gap;
    return static_cast<std::size_t>(gap);
  }

  SamplesLayout layout_;
  TableHead head_;
  std::string_view figures_;  ///< values of the message
  std::size_t rows_ = 0;
  std::size_t missing_ = 0;  ///< rows before it
  std::uint64_t expected_ = 0;
  std::uint64_t taken_rows_ = 0;
  std::uint64_t filled_ = 0;
  std::uint64_t gaps_ = 0;
  std::uint64_t lost_rows_ = 0;
  std::uint64_t first_lost_ = 0;
  std::uint64_t repeats_ = 0;
  bool unfilled_ = false;
};

}  // namespace

Result<std::unique_ptr<Decoder>> samples_decoder(const Topic& topic) {
  auto layout = read_samples_layout(topic.schema.data, topic.channel.metadata);
  if (!layout) return layout.error();
  return std::unique_ptr<Decoder>(std::make_unique<SamplesDecoder>(std::move(layout).value()));
}

}  // namespace proofmass::io::mcap
