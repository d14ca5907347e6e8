#include "proofmass/io/npy_reader.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/array_recording.hpp"
#include "proofmass/io/columns.hpp"
#include "proofmass/io/csv_layout.hpp"
#include "proofmass/io/npy_header.hpp"

namespace proofmass::io {
namespace {

/// One column of figures in a row of bytes.
struct Cursor {
  FigureType type;
  std::size_t offset = 0;
  std::string name;
};

/// How the array lies in the file, as a table.
struct Table {
  std::vector<Cursor> columns;  ///< those that are figures
  std::size_t rows = 0;
  std::size_t row_bytes = 0;  ///< of all columns, the passed over included
  bool by_column = false;     ///< whole columns one after another
  bool is_structured = false;
  bool is_turned = false;  ///< was channels × samples
};

Result<Table> structured_table(const NpyHeader& header) {
  Table table;
  table.is_structured = true;
  table.rows = 1;
  for (const std::size_t length : header.shape)
    if (__builtin_mul_overflow(table.rows, length, &table.rows))
      return Error{Errc::corrupt, "the .npy header claims more samples than can be"};
  for (const NpyField& field : header.fields) {
    if (field.count > most_columns || table.columns.size() + field.count > most_columns)
      return Error{Errc::corrupt, "the .npy header claims too many columns"};
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string name = field.count == 1 ? field.name : fmt::format("{} {}", field.name, i);
      if (field.type.kind != 0) table.columns.push_back({field.type, table.row_bytes, name});
      table.row_bytes += field.type.bytes;
    }
  }
  return table;
}

Result<Table> table_of(const NpyHeader& header) {
  if (header.is_structured) return structured_table(header);
  if (header.shape.empty() || header.shape.size() > 2)
    return Error{Errc::unsupported,
                 fmt::format("holds an array of {} dimensions: expected samples x channels",
                             header.shape.size())};
  Table table;
  table.rows = header.shape[0];
  std::size_t width = header.shape.size() == 2 ? header.shape[1] : 1;
  table.by_column = header.fortran_order;
  constexpr std::size_t most_channels_in_rows = 64;
  if (header.shape.size() == 2 && table.rows <= most_channels_in_rows && width > 4 * table.rows) {
    std::swap(table.rows, width);
    table.by_column = !table.by_column;
    table.is_turned = true;
  }
  if (width > most_columns)
    return Error{Errc::corrupt,
                 fmt::format("the .npy header claims {} columns: too many for a recording", width)};
  const FigureType type = header.fields[0].type;
  for (std::size_t c = 0; c < width; ++c) table.columns.push_back({type, c * type.bytes, ""});
  table.row_bytes = width * type.bytes;
  return table;
}

/// Reads exactly `into`, or what there is.
Result<std::size_t> read_fully(PeekSource& source, std::span<char> into) {
  std::size_t filled = 0;
  while (filled < into.size()) {
    const auto count = source.read(into.subspan(filled));
    if (!count) return count.error();
    if (*count == 0) break;
    filled += *count;
  }
  return filled;
}

struct Preface {
  NpyHeader header;
  std::size_t bytes = 0;
};

Result<Preface> read_preface(PeekSource& source) {
  std::array<char, 12> start{};
  auto count = read_fully(source, std::span(start).first(8));
  if (!count) return count.error();
  const int major = start[6];
  const std::size_t length_bytes = major == 1 ? 2 : 4;
  if (*count < 8 || major < 1 || major > 3)
    return Error{Errc::corrupt, "byte 6: not a version of .npy that is known (1 to 3)"};
  count = read_fully(source, std::span(start).subspan(8, length_bytes));
  if (!count) return count.error();
  std::size_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;)
    length = length * 256 + static_cast<unsigned char>(start[8 + i]);
  constexpr std::size_t longest = std::size_t{1} << 20;
  if (*count < length_bytes || length > longest)
    return Error{Errc::corrupt, "byte 8: the .npy header's length is impossible"};
  std::string dictionary(length, '\0');
  count = read_fully(source, dictionary);
  if (!count) return count.error();
  if (*count < length) return Error{Errc::corrupt, "breaks off within the .npy header"};
  auto header = read_npy_header(dictionary);
  if (!header) return header.error();
  return Preface{*header, 8 + length_bytes + length};
}

/// The columns, and how many rows the file really holds of those it claims.
class TableReader {
 public:
  TableReader(PeekSource& source, const Table& table, const Progress& progress)
      : source_(source), table_(table), progress_(progress) {
    // Only what the file has room for is reserved, whatever the header claims.
    const std::size_t most =
        static_cast<std::size_t>(source.size().value_or(0)) / table.row_bytes + 1;
    const std::size_t expected = std::min(table.rows, most);
    for (std::size_t c = 0; c < table.columns.size(); ++c) columns_.emplace_back(expected);
  }

  Status run() { return table_.by_column ? read_by_column() : read_by_row(); }
  [[nodiscard]] std::size_t rows_read() const { return rows_read_; }
  [[nodiscard]] std::vector<double> take(std::size_t column) { return columns_[column].take(); }

 private:
  static constexpr std::size_t piece_bytes = std::size_t{256} << 10;

  Status read_by_row() {
    const std::size_t rows_a_piece = std::max<std::size_t>(1, piece_bytes / table_.row_bytes);
    std::vector<char> bytes(rows_a_piece * table_.row_bytes);
    std::vector<double> figures(rows_a_piece);
    while (rows_read_ < table_.rows) {
      const std::size_t wanted = std::min(rows_a_piece, table_.rows - rows_read_);
      const auto count = read_fully(source_, std::span(bytes).first(wanted * table_.row_bytes));
      if (!count) return count.error();
      const std::size_t whole = *count / table_.row_bytes;
      for (std::size_t c = 0; c < table_.columns.size(); ++c) {
        const Cursor& column = table_.columns[c];
        for (std::size_t r = 0; r < whole; ++r)
          figures[r] =
              load_figure(bytes.data() + r * table_.row_bytes + column.offset, column.type);
        columns_[c].append(std::span(figures).first(whole));
      }
      rows_read_ += whole;
      if (progress_) progress_("reading", source_.fraction_read());
      if (whole < wanted) break;
    }
    return Done{};
  }

  Status read_by_column() {
    std::vector<char> bytes;
    std::vector<double> figures;
    for (std::size_t c = 0; c < table_.columns.size(); ++c) {
      const FigureType& type = table_.columns[c].type;
      const std::size_t a_piece = piece_bytes / type.bytes;
      bytes.resize(a_piece * type.bytes);
      for (std::size_t row = 0; row < table_.rows;) {
        const std::size_t wanted = std::min(a_piece, table_.rows - row);
        const auto count = read_fully(source_, std::span(bytes).first(wanted * type.bytes));
        if (!count) return count.error();
        if (*count < wanted * type.bytes)
          return Error{Errc::corrupt,
                       fmt::format("breaks off within column {} of {}", c, table_.columns.size())};
        figures.resize(wanted);
        for (std::size_t r = 0; r < wanted; ++r)
          figures[r] = load_figure(bytes.data() + r * type.bytes, type);
        columns_[c].append(figures);
        row += wanted;
      }
    }
    rows_read_ = table_.rows;
    return Done{};
  }

  PeekSource& source_;
  const Table& table_;
  const Progress& progress_;
  std::vector<GrowingColumn> columns_;
  std::size_t rows_read_ = 0;
};

/// Before anything is reserved: a header may not claim more than the file has room for.
Status check_size(const PeekSource& source, const Table& table, std::size_t header_bytes) {
  if (table.rows == 0 || table.row_bytes == 0 || table.columns.empty())
    return Error{Errc::too_few_samples, "holds an empty array"};
  std::size_t wanted = 0;
  if (__builtin_mul_overflow(table.rows, table.row_bytes, &wanted))
    return Error{Errc::corrupt, "the .npy header claims more than any file can hold"};
  if (!source.size()) return Done{};
  const std::uint64_t there =
      *source.size() - std::min<std::uint64_t>(*source.size(), header_bytes);
  if (wanted > there && (table.by_column || there < table.row_bytes))
    return Error{Errc::corrupt,
                 fmt::format("byte {}: the header claims {} bytes of figures, {} are there",
                             header_bytes, wanted, there)};
  return Done{};
}

/// What went wrong with the rows, and what was made of them.
std::vector<Note> notes_of(const Table& table,
                           const TableReader& reader,
                           const PeekSource& source) {
  std::vector<Note> notes;
  if (reader.rows_read() < table.rows)
    notes.push_back({Severity::bad, fmt::format("breaks off after {} of {} samples: those are kept",
                                                reader.rows_read(), table.rows)});
  if (table.is_turned) notes.push_back({Severity::info, "the array is channels x samples: turned"});
  std::ranges::move(source.notes(), std::back_inserter(notes));
  return notes;
}

Result<Recording> assemble(const Table& table,
                           TableReader& reader,
                           std::vector<Note> notes,
                           const ReadOptions& options) {
  Recording recording;
  recording.format = "npy";
  recording.notes = std::move(notes);
  ArrayColumns columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    columns.values.push_back(reader.take(c));
    if (table.is_structured) columns.headings.push_back(table.columns[c].name);
  }
  return recording_of(std::move(columns), std::move(recording), options);
}

}  // namespace

Result<Recording> read_npy(PeekSource& source, const ReadOptions& options) {
  const auto preface = read_preface(source);
  if (!preface) return preface.error();
  const auto table = table_of(preface->header);
  if (!table) return table.error();
  if (const Status fits = check_size(source, *table, preface->bytes); !fits) return fits.error();
  TableReader reader(source, *table, options.progress);
  if (const Status read = reader.run(); !read) return read.error();
  if (reader.rows_read() == 0) return Error{Errc::corrupt, "breaks off before the first sample"};
  return assemble(*table, reader, notes_of(*table, reader, source), options);
}

}  // namespace proofmass::io
