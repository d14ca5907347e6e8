#include "proofmass/io/numpy/npz_reader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include "proofmass/io/matlab/mat_choice.hpp"
#include "proofmass/io/matlab/mat_headings.hpp"
#include "proofmass/io/numpy/npy_figures.hpp"
#include "proofmass/io/numpy/npz_catalogue.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io {
namespace {

using Columns = std::vector<std::vector<double>>;

/// The values of one table, from its first row on.
class NpzColumns {
 public:
  static Result<NpzColumns> open(Archive& archive,
                                 const NpzArray& place,
                                 const matlab::Table& table,
                                 const Progress& progress) {
    auto layout = npy_layout(place.preface, !place.columns && table.is_turned);
    if (!layout) return layout.error();
    auto source = archive.open(place.entry);
    if (!source) return source.error();
    // Column-major data need random access; rows are read while they are decompressed.
    auto bytes = layout->by_column ? random_bytes_of(std::move(source).value(), progress)
                                   : ascending_bytes_of(std::move(source).value());
    if (!bytes) return bytes.error();
    NpyLayout wanted = std::move(layout).value();
    if (place.columns) {
      const auto first = wanted.columns.begin() + static_cast<std::ptrdiff_t>(place.first_column);
      wanted.columns = {first, first + static_cast<std::ptrdiff_t>(*place.columns)};
    }
    auto figures = NpyFigures::open(std::move(bytes).value(), std::move(wanted));
    if (!figures) return figures.error();
    return NpzColumns(std::move(figures).value());
  }

  /// Fills all of `into`, unless the array is truncated.
  Result<std::size_t> read(std::span<const std::span<double>> into) {
    std::size_t done = 0;
    std::vector<std::span<double>> rest(into.begin(), into.end());
    while (done < into[0].size()) {
      const auto count = figures_.read(rest);
      if (!count) return count.error();
      if (*count == 0) break;
      done += *count;
      for (std::span<double>& column : rest) column = column.subspan(*count);
    }
    return done;
  }
  [[nodiscard]] std::vector<Note> notes() const { return figures_.notes(); }

 private:
  explicit NpzColumns(NpyFigures figures) : figures_(std::move(figures)) {}
  NpyFigures figures_;
};

/// The selected tables, read in parallel.
class NpzTable final : public TableReader {
 public:
  NpzTable(TableHead head, std::vector<NpzColumns> parts, const std::vector<matlab::Table>& tables)
      : head_(std::move(head)), parts_(std::move(parts)), rows_(tables.front().rows) {
    for (const matlab::Table& table : tables) widths_.push_back(table.width);
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    std::size_t rows = into[0].size();
    std::size_t column = 0;
    for (std::size_t i = 0; i < parts_.size() && !is_ended_; ++i) {
      const auto count = parts_[i].read(into.subspan(column, widths_[i]));
      if (!count) return count.error();
      rows = std::min(rows, *count);
      column += widths_[i];
    }
    if (is_ended_) return std::size_t{0};
    // A truncated array ends the rows of all.
    is_ended_ = rows < into[0].size();
    rows_read_ += rows;
    return rows;
  }
  [[nodiscard]] std::vector<Note> notes() const override {
    std::vector<Note> notes;
    for (const NpzColumns& part : parts_)
      if (notes.empty()) std::ranges::move(part.notes(), std::back_inserter(notes));
    return notes;
  }
  [[nodiscard]] double fraction_read() const override {
    return static_cast<double>(rows_read_) / static_cast<double>(rows_);
  }

 private:
  TableHead head_;
  std::vector<NpzColumns> parts_;
  std::size_t rows_;  ///< according to the headers
  std::vector<std::size_t> widths_;
  std::size_t rows_read_ = 0;
  bool is_ended_ = false;
};

class NpzOpener {
 public:
  NpzOpener(Archive& archive, const ReadOptions& options)
      : archive_(archive), options_(options), catalogue_(list_npz(archive)) {}

  Result<std::unique_ptr<TableReader>> run() {
    auto choice = matlab::choose_tables(catalogue_.variables, options_);
    if (!choice) return choice.error();
    TableHead head;
    head.format = "npz";
    head.notes = choice->notes;
    for (const matlab::Table& table : choice->tables) head.columns += table.width;
    const auto first = first_rows(choice->tables);
    if (!first) return first.error();
    head.headings = headings_of(choice->tables, *first, options_);
    if (choice->rate != nullptr)
      if (const Status read = read_rate(*choice->rate, head); !read) return read.error();
    auto parts = open_all(choice->tables);
    if (!parts) return parts.error();
    return std::unique_ptr<TableReader>(
        std::make_unique<NpzTable>(std::move(head), std::move(parts).value(), choice->tables));
  }

 private:
  Result<NpzColumns> open(const matlab::Table& table) {
    const auto place = static_cast<std::size_t>(table.array - catalogue_.variables.arrays.data());
    auto columns = NpzColumns::open(archive_, catalogue_.places[place], table, options_.progress);
    if (!columns) return columns.error().at(table.array->path);
    return columns;
  }

  Result<std::vector<NpzColumns>> open_all(const std::vector<matlab::Table>& tables) {
    std::vector<NpzColumns> parts;
    for (const matlab::Table& table : tables) {
      auto part = open(table);
      if (!part) return part.error();
      parts.push_back(std::move(part).value());
    }
    return parts;
  }

  /// The rows that decide whether a first column is the time.
  Result<std::vector<Columns>> first_rows(const std::vector<matlab::Table>& tables) {
    constexpr std::size_t most = 256;
    std::vector<Columns> all;
    for (const matlab::Table& table : tables) {
      auto part = open(table);
      if (!part) return part.error();
      Columns columns(table.width, std::vector<double>(std::min(most, table.rows)));
      const std::vector<std::span<double>> into(columns.begin(), columns.end());
      NpzColumns figures = std::move(part).value();
      const auto count = figures.read(into);
      if (!count) return count.error().at(table.array->path);
      for (auto& column : columns) column.resize(*count);
      all.push_back(std::move(columns));
    }
    return all;
  }

  Status read_rate(const matlab::Array& array, TableHead& head) {
    const auto figure = first_rows({matlab::Table{&array, 1, 1, false}});
    if (!figure) return figure.error();
    const std::vector<double>& values = (*figure)[0][0];
    const bool is_valid = !values.empty() && matlab::is_rate(values[0]);
    if (is_valid) head.rate_hz = values[0];
    head.notes.push_back(
        {Severity::info, fmt::format("{}: {}", array.path,
                                     is_valid ? "the rate in Hz" : "is not a possible rate")});
    return Done{};
  }

  Archive& archive_;
  const ReadOptions& options_;
  NpzCatalogue catalogue_;
};

}  // namespace

bool claims_npz(std::string_view head, std::string_view file_name) {
  constexpr std::size_t name_offset = 30;
  if (!head.starts_with("PK\x03\x04") || head.size() < name_offset) return false;
  const std::size_t size = static_cast<unsigned char>(head[26]) +
                           std::size_t{static_cast<unsigned char>(head[27])} * 256;
  return head.substr(name_offset, size).ends_with(".npy") || file_name.ends_with(".npz");
}

bool holds_npy(const Archive& archive) {
  return std::ranges::any_of(
      archive.entries(), [](const ArchiveEntry& entry) { return entry.name.ends_with(".npy"); });
}

Result<std::unique_ptr<TableFile>> open_npz(std::unique_ptr<Archive> archive,
                                            const ReadOptions& options) {
  auto table = NpzOpener(*archive, options).run();
  if (!table) return table.error();
  auto reader = recording_reader_of(std::move(table).value(), options);
  if (!reader) return reader.error();
  return only_table(std::move(reader).value());
}

Result<std::unique_ptr<TableFile>> open_npz(std::unique_ptr<PeekSource> source,
                                            const ReadOptions& options) {
  auto bytes = random_bytes_of(std::move(source), options.progress);
  if (!bytes) return bytes.error();
  auto archive = open_zip(std::move(bytes).value());
  if (!archive) return archive.error();
  return open_npz(std::move(archive).value(), options);
}

}  // namespace proofmass::io
