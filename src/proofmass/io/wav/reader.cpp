#include "proofmass/io/wav/reader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "proofmass/io/arrays/figure_column.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/text/wording.hpp"
#include "proofmass/io/wav/header.hpp"
#include "proofmass/io/wav/labels.hpp"

namespace proofmass::io::wav {
namespace {

class Table final : public TableReader {
 public:
  Table(std::unique_ptr<RandomBytes> file, Header header)
      : file_(std::move(file)), header_(std::move(header)), labels_(labels_of(header_)) {
    head_.format = "WAV";
    head_.columns = header_.channels;
    head_.headings = labels_.headings;
    head_.start_ns = labels_.start_ns;
    head_.rows = header_.rows();
    head_.notes = header_.notes;
    std::ranges::copy(labels_.notes, std::back_inserter(head_.notes));
    if (header_.rate_hz > 0)
      head_.rate_hz = header_.rate_hz;
    else
      head_.notes.push_back({Severity::warning, "the file says a rate of 0 Hz: none"});
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    const std::size_t row_bytes = header_.row_bytes();
    const std::size_t most = std::max<std::size_t>(piece_bytes / row_bytes, 1);
    std::size_t done = 0;
    while (done < into[0].size() && rows_read_ < header_.rows()) {
      const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(
          std::min(most, into[0].size() - done), header_.rows() - rows_read_));
      piece_.resize(wanted * row_bytes);
      const auto count = file_->read_at(header_.begin + rows_read_ * row_bytes, piece_);
      if (!count) return count.error();
      const std::size_t rows = *count / row_bytes;
      if (rows == 0) break;
      convert(into, done, rows);
      done += rows;
      rows_read_ += rows;
    }
    return done;
  }
  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes = file_->notes();
    if (header_.claimed_bytes)
      notes.push_back(
          {Severity::bad,
           fmt::format("byte {}: breaks off after {} of {} samples: those are kept", file_->size(),
                       header_.rows(), *header_.claimed_bytes / header_.row_bytes())});
    if (lost_ > 0)
      notes.push_back({Severity::warning,
                       fmt::format("{} samples are marked as lost by the instrument, the first {}: "
                                   "NaN",
                                   lost_, first_lost_)});
    return notes;
  }
  [[nodiscard]] double fraction_read() const override {
    return static_cast<double>(rows_read_) / static_cast<double>(header_.rows());
  }

 private:
  static constexpr std::size_t piece_bytes = std::size_t{256} << 10;

  void convert(std::span<const std::span<double>> into, std::size_t done, std::size_t rows) {
    for (std::size_t c = 0; c < into.size(); ++c) {
      const std::span<double> out = into[c].subspan(done, rows);
      load_figures(piece_.data() + c * header_.figure.bytes, header_.row_bytes(), header_.figure,
                   out);
      if (labels_.factors[c] != 1.0)
        for (double& value : out) value *= labels_.factors[c];
    }
    if (labels_.validity) strike_lost(into, done, rows);
  }

  /// The sign bit of the auxiliary channel marks missing data.
  void strike_lost(std::span<const std::span<double>> into, std::size_t done, std::size_t rows) {
    const std::span<double> auxiliary = into[*labels_.validity];
    for (std::size_t k = done; k < done + rows; ++k) {
      if (auxiliary[k] >= 0.0) continue;
      if (lost_++ == 0) first_lost_ = rows_read_ + k - done;
      for (std::size_t c = 0; c < into.size(); ++c)
        if (labels_.factors[c] != 1.0) into[c][k] = std::numeric_limits<double>::quiet_NaN();
    }
  }

  std::unique_ptr<RandomBytes> file_;
  Header header_;
  Labels labels_;
  TableHead head_;
  std::uint64_t rows_read_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t first_lost_ = 0;
  std::vector<char> piece_;
};

}  // namespace

bool claims(std::string_view head, std::string_view) {
  if (head.size() < 12) return false;
  const std::string_view form = head.substr(0, 4);
  return (form == "RIFF" || form == "RIFX" || form == "RF64" || form == "BW64") &&
         head.substr(8, 4) == "WAVE";
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  auto file = random_bytes_of(std::move(source), options.progress);
  if (!file) return file.error();
  std::unique_ptr<RandomBytes> bytes = std::move(file).value();
  auto header = read_header(*bytes);
  if (!header) return header.error();
  auto reader = recording_reader_of(
      std::make_unique<Table>(std::move(bytes), std::move(header).value()), options);
  if (!reader) return reader.error();
  return only_table(std::move(reader).value());
}

}  // namespace proofmass::io::wav
