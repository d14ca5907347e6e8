#include "proofmass/io/parquet/reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "proofmass/io/bytes/library_file.hpp"
#include "proofmass/io/bytes/subprocess.hpp"
#include "proofmass/io/bytes/subprocess_words.hpp"
#include "proofmass/io/parquet/child.hpp"
#include "proofmass/io/parquet/facts.hpp"
#include "proofmass/io/reading/labelled_reader.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io::parquet {
namespace {

template <class T>
std::optional<T> figure(std::string_view text) {
  T value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Rows as sent by the child: frames of doubles, column by column.
class ChunkReader final : public TableReader {
 public:
  ChunkReader(Subprocess child, TableHead head)
      : child_(std::move(child)), head_(std::move(head)) {}

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] double fraction_read() const override {
    const auto all = static_cast<double>(head_.rows.value_or(0));
    return all > 0.0 ? std::min(static_cast<double>(rows_read_) / all, 1.0) : 0.0;
  }

  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    const std::size_t wanted = into.front().size();
    std::size_t had = 0;
    while (had < wanted) {
      if (row_ == rows_) {
        if (const Status heard = hear(); !heard) return heard.error();
        if (rows_ == 0) break;
      }
      const std::size_t count = std::min(wanted - had, rows_ - row_);
      for (std::size_t c = 0; c < head_.columns; ++c)
        std::ranges::copy(std::span(block_).subspan(c * rows_ + row_, count),
                          into[c].subspan(had, count).begin());
      had += count;
      row_ += count;
    }
    rows_read_ += had;
    return had;
  }

 private:
  /// Receives the next block, without rows at the end.
  Status hear() {
    row_ = 0;
    rows_ = 0;
    const auto bytes = child_.next();
    if (!bytes) return bytes.error();
    const std::size_t a_row = head_.columns * sizeof(double);
    if (bytes->size() % a_row != 0)
      return Error{Errc::corrupt, "is damaged: what was unpacked of it breaks off"};
    rows_ = bytes->size() / a_row;
    block_.resize(rows_ * head_.columns);
    if (rows_ > 0) std::memcpy(block_.data(), bytes->data(), bytes->size());
    return Done{};
  }

  Subprocess child_;
  TableHead head_;
  std::vector<double> block_;
  std::size_t rows_ = 0;  ///< in the block
  std::size_t row_ = 0;   ///< the next one in the block
  std::uint64_t rows_read_ = 0;
};

/// Information of the child on the file, before the first row.
Result<Head> hear_head(Subprocess& child) {
  std::string bytes;
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  for (;;) {
    const auto piece = child.next();
    if (!piece) return piece.error();
    bytes.append(piece->data(), piece->size());
    const auto wanted = head_bytes(bytes);
    if (wanted && *wanted <= bytes.size()) return decode(bytes);
    if (piece->empty() || bytes.size() > most_bytes)
      return Error{Errc::corrupt, "is damaged: its contents cannot be listed"};
  }
}

struct OpenParquet {
  LibraryFile file;
  std::vector<Note> notes;  ///< about decompression
};

struct OpenTable {
  std::unique_ptr<TableReader> reader;
  Head head;
};

/// Notes on short texts in the metadata, except those that describe the columns.
void note_texts(const Head& parquet, std::vector<Note>& notes) {
  constexpr std::size_t most_texts = 4;
  constexpr std::size_t longest = 160;
  using namespace parquet;
  constexpr std::array own{rate_key, start_key, time_key, labels_key, label_channel_key};
  std::size_t noted = 0;
  for (const auto& [key, text] : parquet.facts) {
    const bool is_of_columns = std::ranges::find(own, key) != own.end() ||
                               key.starts_with(unit_prefix) || key.starts_with(name_prefix);
    if (is_of_columns || text.empty() || text.size() > longest || noted == most_texts) continue;
    notes.push_back({Severity::info, printable(key + ": " + text)});
    ++noted;
  }
}

TableHead table_head(const Head& parquet, const OpenParquet& file) {
  TableHead head;
  head.format = "Parquet";
  head.columns = parquet.columns.size();
  for (const Column& column : parquet.columns)
    head.headings.push_back(column.unit.empty() ? column.name
                                                : fmt::format("{} ({})", column.name, column.unit));
  head.rows = parquet.rows;
  head.notes = file.notes;
  std::string read;
  for (const Column& column : parquet.columns) {
    if (read.size() > 300) {
      read += ", …";
      break;
    }
    read += fmt::format("{}{} ({})", read.empty() ? "" : ", ", column.name, column.type);
  }
  head.notes.push_back({Severity::info, fmt::format("Parquet: {} read", read)});
  if (!parquet.skipped.empty())
    head.notes.push_back({Severity::info, "also in the file: " + parquet.skipped});
  note_texts(parquet, head.notes);
  const auto start_ns = figure<std::int64_t>(parquet.fact(parquet::start_key));
  if (parquet.stamps) {
    Unit unit = parse_unit(parquet.columns[*parquet.stamps].unit).value_or(Unit{});
    StampOrigin origin{parquet.origin, 0};
    if (parquet.is_since_start) origin = {start_ns.value_or(0), -9};
    if (!parquet.is_since_start || start_ns) head.stamps = {*parquet.stamps, unit, origin};
    return head;
  }
  head.rate_hz = figure<double>(parquet.fact(parquet::rate_key));
  if (head.rate_hz && !(*head.rate_hz > 0.0 && *head.rate_hz < 1e12)) head.rate_hz.reset();
  if (head.rate_hz) head.start_ns = start_ns;
  return head;
}

ChildLimits limits_for(const LibraryFile& file) {
  constexpr std::uint64_t bytes_a_second = 200'000;  // rate for maximally compressed data
  constexpr std::uint64_t longest_s = 360'000;
  ChildLimits limits;
  limits.memory_bytes = std::size_t{4} << 30;  // DuckDB reserves more than it uses
  limits.cpu_s += static_cast<unsigned>(std::min(file.size() / bytes_a_second, longest_s));
  return limits;
}

Result<OpenTable> open_table(const OpenParquet& file, const ReadOptions& options) {
  const auto work = [&](const ByteSink& sink) {
    return read_values(file.file.path(), options, sink);
  };
  auto started = Subprocess::start(work, limits_for(file.file));
  if (!started) return started.error();
  Subprocess child = std::move(started).value();
  auto heard = hear_head(child);
  if (!heard) return heard.error();
  OpenTable table{nullptr, std::move(heard).value()};
  table.reader = std::make_unique<ChunkReader>(std::move(child), table_head(table.head, file));
  return table;
}

class File final : public TableFile {
 public:
  File(OpenParquet file, OpenTable first) : file_(std::move(file)), first_(std::move(first)) {
    const TableHead& head = first_.reader->head();
    summary_[0] = {
        .name = {}, .headings = head.headings, .rows = head.rows, .rate_hz = head.rate_hz};
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return summary_; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t,
                                                              const ReadOptions& options) override {
    if (!first_.reader) {
      auto table = open_table(file_, options);
      if (!table) return table.error();
      first_ = std::move(table).value();
    }
    auto opened = recording_reader_of(std::exchange(first_.reader, nullptr), options);
    if (!opened) return opened;
    return labelled(std::move(opened).value(), first_.head.labels(),
                    std::string(first_.head.fact(parquet::label_channel_key)), first_.head.rows);
  }

 private:
  OpenParquet file_;
  OpenTable first_;  ///< its reader until it is requested
  std::array<TableSummary, 1> summary_;
};

}  // namespace

bool claims(std::string_view head, std::string_view) {
  return head.starts_with("PAR1");
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  auto spooled = library_file_of(*source, options.progress);
  if (!spooled) return spooled.error();
  OpenParquet file{std::move(spooled).value(), source->notes()};
  auto first = open_table(file, options);
  if (!first) return first.error();
  return std::unique_ptr<TableFile>(
      std::make_unique<File>(std::move(file), std::move(first).value()));
}

}  // namespace proofmass::io::parquet
