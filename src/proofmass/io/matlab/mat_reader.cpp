#include "proofmass/io/matlab/mat_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <iterator>
#include <memory>

#include "proofmass/io/arrays/recording.hpp"
#include "proofmass/io/matlab/mat_choice.hpp"
#include "proofmass/io/matlab/mat_headings.hpp"

namespace proofmass::io::matlab {
namespace {

Result<std::string> read_all(PeekSource& source, const Progress& progress) {
  constexpr std::size_t smallest_piece = std::size_t{1} << 14;
  constexpr std::size_t largest_piece = std::size_t{1} << 22;
  constexpr std::size_t most_unpacked = std::size_t{4} << 30;
  std::string bytes;
  if (source.size()) bytes.reserve(*source.size());
  for (;;) {
    const std::size_t had = bytes.size();
    if (!source.size() && had > most_unpacked)
      return Error{Errc::unsupported, "is larger than 4 GiB: unpack it into a file first"};
    bytes.resize(had + std::clamp(had, smallest_piece, largest_piece));
    const auto count = source.read(std::span(bytes).subspan(had));
    bytes.resize(had + (count ? *count : 0));
    if (!count) return count.error();
    if (*count == 0) return bytes;
    if (progress) progress("reading", source.fraction_read());
  }
}

using Columns = std::vector<std::vector<double>>;

/// Reads values; continues within a variable if possible, because going back requires decompressing
/// it again.
class FigureReader {
 public:
  explicit FigureReader(std::string_view file) : file_(file) {}

  /// An integer of eight bytes, exact.
  Result<std::int64_t> read_whole(const Array& array) {
    std::array<char, 8> bytes{};
    if (const Status found = go_to(array); !found) return found.error();
    if (const Status read = stream_->read(bytes); !read) return read.error();
    const bool is_native = array.stored.big_endian == (std::endian::native == std::endian::big);
    if (!is_native) std::ranges::reverse(bytes);
    return std::bit_cast<std::int64_t>(bytes);
  }

  Result<Columns> read(const Table& table) {
    Columns columns(table.width);
    for (auto& column : columns) column.reserve(table.rows);
    const FigureType& type = table.array->stored;
    if (const Status found = go_to(*table.array); !found) return found.error();
    // Whole rows of a turned table are read together.
    const std::size_t most = std::min(piece_figures / table.width * table.width, table.figures());
    std::vector<char> bytes(most * type.bytes);
    for (std::size_t at = 0; at < table.figures();) {
      const std::size_t count = std::min(most, table.figures() - at);
      if (const Status read = stream_->read(std::span(bytes).first(count * type.bytes)); !read)
        return read.error();
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t column = table.is_turned ? i % table.width : (at + i) / table.rows;
        columns[column].push_back(load_figure(bytes.data() + i * type.bytes, type));
      }
      at += count;
    }
    return columns;
  }

 private:
  static constexpr std::size_t piece_figures = std::size_t{1} << 15;

  Status go_to(const Array& array) {
    const bool goes_on =
        stream_ && region_offset_ == array.region.offset && stream_->position() <= array.begin;
    if (!goes_on) stream_ = std::make_unique<Stream>(file_, array.region);
    region_offset_ = array.region.offset;
    return stream_->skip(array.begin - stream_->position());
  }

  std::string_view file_;
  std::unique_ptr<Stream> stream_;
  std::size_t region_offset_ = 0;
};

/// The rate in a scalar; a note if it is implausible.
Result<std::optional<double>> rate_of(const Array& array,
                                      FigureReader& reader,
                                      std::vector<Note>& notes) {
  const auto figure = reader.read({&array, 1, 1, false});
  if (!figure) return figure.error();
  const double rate_hz = (*figure)[0][0];
  notes.push_back({Severity::info,
                   fmt::format("{}: {}", array.path,
                               is_rate(rate_hz) ? "the rate in Hz" : "is not a possible rate")});
  return is_rate(rate_hz) ? std::optional(rate_hz) : std::nullopt;
}

}  // namespace

bool claims(std::string_view head, std::string_view) {
  return is_mat5(head) || is_mat4(head);
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  const auto file = read_all(*source, options.progress);
  if (!file) return file.error();
  const auto catalogue = is_mat5(*file) ? list_mat5(*file) : list_mat4(*file);
  if (!catalogue) return catalogue.error();
  const auto choice = choose_tables(*catalogue, options);
  if (!choice) return choice.error();
  Recording recording;
  recording.format = std::string(catalogue->version);
  recording.notes = choice->notes;
  std::ranges::move(source->notes(), std::back_inserter(recording.notes));
  FigureReader reader(*file);
  std::vector<Columns> values;
  for (const Table& table : choice->tables) {
    auto columns = reader.read(table);
    if (!columns) return columns.error();
    values.push_back(std::move(columns).value());
  }
  ArrayColumns columns;
  columns.headings = headings_of(choice->tables, values, options);
  note_headings(*catalogue, choice->tables, columns.headings);
  for (Columns& some : values) std::ranges::move(some, std::back_inserter(columns.values));
  if (choice->rate != nullptr) {
    const auto rate_hz = rate_of(*choice->rate, reader, recording.notes);
    if (!rate_hz) return rate_hz.error();
    columns.rate_hz = *rate_hz;
  }
  if (choice->start != nullptr && choice->start->stored.bytes == 8) {
    const auto start_ns = reader.read_whole(*choice->start);
    if (!start_ns) return start_ns.error();
    columns.start_ns = *start_ns;
  }
  auto made = recording_reader_of(std::move(columns), std::move(recording), options);
  if (!made) return made.error();
  return only_table(std::move(made).value());
}

}  // namespace proofmass::io::matlab
