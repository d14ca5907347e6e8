#include <algorithm>
#include <charconv>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <set>
#include <sys/file.h>
#include <unistd.h>

#include "proofmass/core/new_file.hpp"
#include "proofmass/fleet/entry_json.hpp"
#include "proofmass/fleet/results.hpp"

namespace proofmass::fleet {
namespace {

using io::parquet::TableCell;

/// The table's columns in their order, each known by its name.
class Columns {
 public:
  void take(const std::string& name, const TableCell& cell) {
    const auto [place, is_new] = places_.try_emplace(name, columns_.size());
    if (is_new) columns_.push_back({name, false});
    if (std::holds_alternative<std::string>(cell)) columns_[place->second].is_text = true;
  }
  [[nodiscard]] std::size_t place(const std::string& name) const { return places_.at(name); }
  [[nodiscard]] const std::vector<io::parquet::TableColumn>& all() const { return columns_; }

 private:
  std::vector<io::parquet::TableColumn> columns_;
  std::map<std::string, std::size_t> places_;
};

// "0012" is a serial number, and a text.
TableCell cell_of(const std::string& text) {
  if (text.empty()) return std::monostate{};
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const std::size_t digit = text[0] == '-' ? 1 : 0;
  const bool is_padded = text.size() > digit + 1 && text[digit] == '0' && text[digit + 1] != '.' &&
                         text[digit + 1] != 'e';
  if (error != std::errc() || stop != end || is_padded) return text;
  return value;
}

// The row of one recording and channel, in the table's order.
Row full_row(const Entry& entry, const Row& figures) {
  Row row{{"file", entry.path}};
  std::set<std::string> taken{"file", "verb", "flags", "document", "report"};
  for (const auto& [name, value] : entry.columns)
    if (taken.insert(name).second) row.emplace_back(name, cell_of(value));
  row.emplace_back("verb", entry.verb);
  for (const auto& [name, cell] : figures)
    row.emplace_back(taken.contains(name) ? entry.verb + "_" + name : name, cell);
  row.emplace_back("flags", fmt::format("{}", fmt::join(entry.flags, " ")));
  row.emplace_back("document", entry.document);
  if (!entry.report.empty()) row.emplace_back("report", entry.report);
  return row;
}

/// Rows on their way into the file, a group at a time.
class Groups {
 public:
  Groups(io::parquet::TableWriter& table, const Columns& columns)
      : table_(&table), columns_(&columns), cells_(columns.all().size()) {}

  Status add(const Row& row) {
    constexpr std::size_t most = 4096;
    for (auto& column : cells_) column.emplace_back();
    for (const auto& [name, cell] : row) cells_[columns_->place(name)].back() = cell;
    return cells_.front().size() < most ? Status(Done{}) : flush();
  }
  Status flush() {
    const Status done = table_->add(cells_);
    for (auto& column : cells_) column.clear();
    return done;
  }

 private:
  io::parquet::TableWriter* table_;
  const Columns* columns_;
  std::vector<std::vector<TableCell>> cells_;
};

Status write_rows(const Results& results) {
  Columns columns;
  columns.take("file", std::string());
  const Status named = results.visit([&](const Entry& entry) -> Status {
    for (const Row& figures : entry.rows)
      for (const auto& [name, cell] : full_row(entry, figures)) columns.take(name, cell);
    return Done{};
  });
  if (!named) return named;
  auto created = io::parquet::TableWriter::create(
      (std::filesystem::path(results.folder()) / "results.parquet").string(), columns.all());
  if (!created) return created.error();
  io::parquet::TableWriter table = std::move(created).value();
  Groups groups(table, columns);
  const Status added = results.visit([&](const Entry& entry) -> Status {
    for (const Row& figures : entry.rows)
      if (const Status done = groups.add(full_row(entry, figures)); !done) return done;
    return Done{};
  });
  if (!added) return added;
  if (const Status flushed = groups.flush(); !flushed) return flushed;
  return table.finish();
}

Status write_failures(const Results& results) {
  auto created =
      NewFile::create((std::filesystem::path(results.folder()) / "failures.ndjson").string());
  if (!created) return created.error();
  NewFile file = std::move(created).value();
  const Status written = results.visit([&](const Entry& entry) -> Status {
    return entry.failure.empty() ? Status(Done{}) : file.append(failure_line(entry) + '\n');
  });
  return written ? file.keep() : written;
}

/// One process at a time, so that the last to write has seen all the lines of the others.
class TableLock {
 public:
  explicit TableLock(const std::string& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ >= 0) ::flock(descriptor_, LOCK_EX);
  }
  TableLock(const TableLock&) = delete;
  TableLock& operator=(const TableLock&) = delete;
  ~TableLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

}  // namespace

Status write_tables(const std::string& folder) {
  const TableLock lock(folder);
  const auto results = Results::read(folder);
  if (!results) return results.error();
  if (const Status rows = write_rows(*results); !rows) return rows;
  return write_failures(*results);
}

}  // namespace proofmass::fleet
