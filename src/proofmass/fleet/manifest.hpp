#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"

// Which recordings a fleet consists of, and what is known of each.
namespace proofmass::fleet {

/// Named fields of one recording, in the manifest's order.
using ManifestFields = std::vector<std::pair<std::string, std::string>>;

/// The field of that name; empty if there is none.
[[nodiscard]] std::string_view manifest_field(const ManifestFields& fields, std::string_view name);

/// One recording with its flags, or several that are analysed as one.
struct Job {
  std::string path;                ///< as it is opened: relative to the working folder
  std::vector<std::string> flags;  ///< for this recording only
  ManifestFields columns;          ///< all others of the manifest: sensor, temperature, date, …
  /// Recordings of a group, in the order of time; `path` is then the group's name.
  std::vector<std::string> parts = {};
  std::vector<double> starts_s = {};  ///< start of each part; empty: unknown

  /// The same for the same recording and flags, whatever the other columns say.
  [[nodiscard]] std::string id() const;
};

/// Reads a table of recordings, or makes one of a folder's files: `path` or `file` is the
/// recording, relative to the manifest's folder unless it is a URL; `flags` are words as a shell
/// takes them. CSV (comma, semicolon or tab), .parquet (by DuckDB's library) or .ndjson/.jsonl. Of
/// a folder all files in it and below are taken, in the order of their names, less hidden ones,
/// folders of results, tables named manifest.*, and what is written beside recordings (.truth.csv,
/// .json, .html, .toml, .md, .part). Errors: unreadable; corrupt, with the line; invalid_argument
/// (no column path, no recording, one that is listed twice with the same flags).
[[nodiscard]] Result<std::vector<Job>> read_manifest(const std::string& path,
                                                     const std::string& duckdb_library);

/// The fields of CSV text, rows of equal length. Source: RFC 4180. Errors: corrupt, with the line.
[[nodiscard]] Result<std::vector<std::vector<std::string>>> csv_fields(std::string_view text);

/// Words as a shell takes them: blanks part them, quotes and backslashes keep them together.
/// Errors: corrupt (a quote that is not closed).
[[nodiscard]] Result<std::vector<std::string>> shell_words(std::string_view text);

/// `common` flags and after them `own`; a common flag that `own` gives too is left out.
[[nodiscard]] std::vector<std::string> merged_flags(const std::vector<std::string>& common,
                                                    const std::vector<std::string>& own);

/// One job for each value of a column ("sensor"): its recordings by date, with their starts where
/// all dates have a time of day, and the columns that they have in common; of the dates the first.
/// Errors: invalid_argument (no such column, a recording without a value, flags that differ).
[[nodiscard]] Result<std::vector<Job>> grouped_by(const std::vector<Job>& jobs,
                                                  const std::string& column);

/// Days since 1970 of "2026-11-25", "2026-11-25T04:30:00.5Z", "2026-11-25T04:30+02:00"; nullopt of
/// anything else.
[[nodiscard]] std::optional<double> day_of(std::string_view date);

/// Every n-th recording, from the i-th on: shards of a manifest share nothing and leave nothing
/// out.
[[nodiscard]] std::vector<Job> shard_of(const std::vector<Job>& jobs, std::size_t i, std::size_t n);

}  // namespace proofmass::fleet
