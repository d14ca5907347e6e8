#include "proofmass/io/layouts/tables.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>

#include "proofmass/io/archive/names.hpp"
#include "proofmass/io/formats.hpp"
#include "proofmass/io/layouts/hinted_reader.hpp"
#include "proofmass/io/layouts/layout.hpp"
#include "proofmass/io/layouts/zip_reader.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/numpy/npz_reader.hpp"

namespace proofmass::io {
namespace {

constexpr std::size_t most_looked_at = 512;

/// The supported programs, one line each.
constexpr std::array layouts = {read_named_sensors, read_sensor_logger_layout, read_phyphox_layout,
                                ximu::read_layout};

/// True if a file is irrelevant: hidden, or created by a desktop.
bool is_litter(std::string_view name) {
  return name.starts_with('.') || name.find("/.") != std::string_view::npos ||
         name.starts_with("__MACOSX/") || file_part(name) == "Thumbs.db";
}

bool is_npy(std::string_view name) {
  return lower(name).ends_with(".npy");
}

/// One table of one file.
struct Member {
  std::size_t entry = 0;
  std::size_t table = 0;  ///< index of the table within the file
};

/// Files that are not recordings, and those that should be and cannot be read.
struct SkippedFiles {
  std::size_t count = 0;
  std::string names;
  std::vector<Note> notes;
  std::optional<Error> first;

  void add(const std::string& name, const Error& error) {
    const bool is_damaged = (error.code == Errc::corrupt || error.code == Errc::unreadable) &&
                            without_endings(name) != name;
    if (!first || (is_damaged && notes.empty())) first = error.at(name);
    constexpr std::size_t most_listed = 8;
    if (is_damaged) {
      if (notes.size() < most_listed)
        notes.push_back({Severity::warning, name + " is not read: " + error.message});
      return;
    }
    if (++count <= most_listed) names += (names.empty() ? "" : ", ") + name;
  }
  /// Summary of the notes.
  [[nodiscard]] std::vector<Note> all_notes() const {
    std::vector<Note> all = notes;
    if (count > 0)
      all.push_back({Severity::info, fmt::format("skipped, being no recordings: {}{}", names,
                                                 count > 8 ? ", …" : "")});
    return all;
  }
};

/// Number of lines that begin like a row of numbers; nullopt if the allowed bytes are exhausted.
std::optional<std::uint64_t> count_rows(PeekSource& text, std::uint64_t& allowed_bytes) {
  std::uint64_t rows = 0;
  bool at_begin = true;
  std::vector<char> buffer(std::size_t{64} << 10);
  for (;;) {
    const auto count = text.read(buffer);
    if (!count || *count > allowed_bytes) return std::nullopt;
    if (*count == 0) return rows;
    allowed_bytes -= *count;
    for (const char c : std::span(buffer).first(*count)) {
      if (c == '\n') {
        at_begin = true;
      } else if (at_begin && c != ' ' && c != '\t' && c != '"') {
        at_begin = false;
        if ((c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.') ++rows;
      }
    }
  }
}

class ArchiveTables final : public TableFile {
 public:
  explicit ArchiveTables(std::unique_ptr<Archive> archive) : archive_(std::move(archive)) {
    for (const auto read : layouts) read(*archive_, layout_);
  }

  /// Opens the files for their headings. Errors: too_few_samples, or that of the only file.
  Status look_at_files(const ReadOptions& options) {
    ReadOptions plain;
    plain.rate_hz = options.rate_hz;
    plain.duckdb_library = options.duckdb_library;
    std::size_t looked_at = 0;
    for (std::size_t e = 0; e < archive_->entries().size(); ++e) {
      const auto hint = layout_.find(e);
      if (is_litter(archive_->entries()[e].name)) continue;
      if (hint != layout_.end() && !hint->second.is_recording) continue;
      if (++looked_at > most_looked_at) continue;
      look_at(e, plain);
    }
    notes_ = skipped_.all_notes();
    if (looked_at > most_looked_at)
      notes_.push_back({Severity::warning, fmt::format("holds {} files: the first {} are looked at",
                                                       looked_at, most_looked_at)});
    if (members_.empty()) return nothing_found();
    name_tables();
    if (members_.size() > 1) count_rows_of_texts();
    return Done{};
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return summaries_; }

  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t table,
                                                              const ReadOptions& options) override {
    const Member& member = members_[table];
    const std::string& name = archive_->entries()[member.entry].name;
    ReadOptions mine = options;
    mine.variables.clear();
    auto file = open_file_in(member.entry, mine);
    if (!file) return file.error().at(name);
    if (member.table >= (*file)->tables().size())
      return Error{Errc::unreadable, "has changed since it was looked at"}.at(name);
    auto reader = (*file)->open(member.table, mine);
    if (!reader) return reader.error().at(name);
    const auto known = layout_.find(member.entry);
    MemberHint hint = known == layout_.end() ? MemberHint{} : known->second;
    if (members_.size() == 1)
      hint.notes.insert(hint.notes.begin(), {Severity::info, "read from its file " + name});
    hint.notes.insert(hint.notes.end(), notes_.begin(), notes_.end());
    return with_hint(std::move(reader).value(), hint);
  }

 private:
  [[nodiscard]] Result<std::unique_ptr<TableFile>> open_file_in(std::size_t entry,
                                                                const ReadOptions& options) {
    auto source = archive_->open(entry);
    if (!source) return source.error();
    std::unique_ptr<PeekSource> opened = std::move(source).value();
    const auto head = opened->peek(4);
    if (!head) return head.error();
    const std::string& name = archive_->entries()[entry].name;
    // An archive may contain itself.
    if (claims_zip(*head, name) && !lower(name).ends_with(".npz"))
      return Error{Errc::unsupported, "is an archive within: unpack it, or name it by itself"};
    return open_tables(std::move(opened), name, options);
  }

  void look_at(std::size_t entry, const ReadOptions& options) {
    const std::string& name = archive_->entries()[entry].name;
    const auto file = open_file_in(entry, options);
    if (!file) {
      skipped_.add(name, file.error());
      return;
    }
    const auto hint = layout_.find(entry);
    for (std::size_t t = 0; t < (*file)->tables().size(); ++t) {
      TableSummary summary = (*file)->tables()[t];
      if (hint != layout_.end()) apply(hint->second, summary);
      members_.push_back({entry, t});
      summaries_.push_back(std::move(summary));
    }
  }

  static void apply(const MemberHint& hint, TableSummary& summary) {
    for (std::string& heading : summary.headings) {
      const ColumnLabel was = read_label(heading);
      const ColumnLabel label = with_hint(was, hint);
      if (label.name == was.name && label.unit == was.unit) continue;
      heading = label.name + (label.unit.symbol.empty() ? "" : " (" + label.unit.symbol + ")");
    }
    if (!summary.rate_hz) summary.rate_hz = hint.rate_hz;
  }

  [[nodiscard]] Status nothing_found() const {
    if (!skipped_.first) return Error{Errc::too_few_samples, "holds no file"};
    const std::size_t files = skipped_.count + skipped_.notes.size();
    if (files == 1) return *skipped_.first;
    return Error{skipped_.first->code,
                 fmt::format("holds no recording: none of {} files is one; {}", files,
                             skipped_.first->message)};
  }

  /// The folder common to all tables, which can be omitted from their names.
  [[nodiscard]] std::string common_folder() const {
    std::string common(folder_part(archive_->entries()[members_.front().entry].name));
    for (const Member& member : members_) {
      const std::string& name = archive_->entries()[member.entry].name;
      while (!name.starts_with(common)) {
        common.pop_back();
        common = folder_part(common);
      }
    }
    return common;
  }

  void name_tables() {
    const std::size_t skip = common_folder().size();
    const auto name_of = [&](const Member& member) {
      return archive_->entries()[member.entry].name.substr(skip);
    };
    std::map<std::string, std::size_t> files;   // by name without extensions
    std::map<std::size_t, std::size_t> tables;  // by entry
    for (const Member& member : members_) {
      if (member.table == 0) ++files[without_endings(name_of(member))];
      ++tables[member.entry];
    }
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const std::string file = name_of(members_[m]);
      const std::string stem = without_endings(file);
      std::string& name = summaries_[m].name;
      const bool is_lone = tables[members_[m].entry] == 1;
      name = (files[stem] > 1 ? file : stem) + (is_lone || name.empty() ? "" : "/" + name);
    }
  }

  /// For text files, whose number of rows can only be estimated in advance, while they are short.
  void count_rows_of_texts() {
    std::uint64_t allowed_bytes = std::uint64_t{256} << 20;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      if (members_[m].table > 0) continue;
      const auto source = archive_->open(members_[m].entry);
      if (!source) continue;
      constexpr std::size_t enough = 1024;
      const auto head = (*source)->peek(enough);
      if (!head || head->find('\0') != std::string_view::npos) continue;
      const auto rows = count_rows(**source, allowed_bytes);
      if (!rows) return;
      if (*rows > 0) summaries_[m].rows = rows;
    }
  }

  std::unique_ptr<Archive> archive_;
  ArchiveLayout layout_;
  std::vector<Member> members_;
  std::vector<TableSummary> summaries_;  ///< one per member
  SkippedFiles skipped_;
  std::vector<Note> notes_;
};

bool is_office_document(const Archive& archive) {
  return std::ranges::any_of(archive.entries(), [](const ArchiveEntry& entry) {
    return entry.name == "[Content_Types].xml" || entry.name == "content.xml";
  });
}

bool is_all_npy(const Archive& archive) {
  bool any = false;
  for (const ArchiveEntry& entry : archive.entries()) {
    if (is_litter(entry.name)) continue;
    if (!is_npy(entry.name)) return false;
    any = true;
  }
  return any;
}

}  // namespace

Result<std::unique_ptr<TableFile>> open_tables_in(std::unique_ptr<Archive> archive,
                                                  const ReadOptions& options) {
  if (is_office_document(*archive))
    return Error{Errc::unsupported,
                 "is an office document (xlsx, …), which is not read: export the table as CSV"};
  if (is_all_npy(*archive)) return open_npz(std::move(archive), options);
  auto tables = std::make_unique<ArchiveTables>(std::move(archive));
  if (const Status looked = tables->look_at_files(options); !looked) return looked.error();
  return std::unique_ptr<TableFile>(std::move(tables));
}

}  // namespace proofmass::io
