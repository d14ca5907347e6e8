#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/fleet/figures.hpp"
#include "proofmass/fleet/manifest.hpp"

// The folder that a fleet's results are in:
//   journal.ndjson, journal-2-of-4.ndjson   a line for each recording done, of each shard
//   documents/                              each recording's JSON document
//   results.parquet, failures.ndjson        made of the journals; whole at any time
namespace proofmass::fleet {

/// What became of one recording: a line of a journal.
struct Entry {
  std::string verb, path;
  std::vector<std::string> own_flags;  ///< from the manifest, for this recording
  std::vector<std::string> flags;      ///< all that the verb was run with
  ManifestFields columns;
  std::vector<std::string> parts;  ///< the recordings of a group
  std::vector<InputSum> inputs;
  std::string version, commit;
  double ended_s = 0.0;          ///< seconds since 1970
  double seconds = 0.0;          ///< that it took
  std::string document, report;  ///< relative to the folder; empty: none
  std::vector<Row> rows;
  std::string failure;      ///< empty: done
  bool is_lasting = false;  ///< the same bytes and flags would fail again

  [[nodiscard]] std::string id() const { return Job{path, own_flags, {}}.id(); }
};

/// Which part of the jobs one process does; all of them where n is 1.
struct Shard {
  std::size_t i = 0, n = 1;
};

/// The journals of a folder of results. Among several lines for one recording the one that
/// ended last counts. A line that a kill has left unfinished is skipped.
class Results {
 public:
  /// To read. Errors: unreadable (no such folder, no journal).
  [[nodiscard]] static Result<Results> read(const std::string& folder);

  /// To add to, as one shard: makes what is not there, and holds the shard's journal so that no
  /// other process adds to it. Errors: unwritable; invalid_argument (another process does).
  [[nodiscard]] static Result<Results> open(const std::string& folder, const Shard& shard);

  Results(Results&&) noexcept;
  Results& operator=(Results&&) noexcept;
  Results(const Results&) = delete;
  Results& operator=(const Results&) = delete;
  ~Results();

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] std::optional<Entry> find(const std::string& id) const;

  /// In the order of the recordings' names. Errors: unreadable; those of `take`, which end it.
  [[nodiscard]] Status visit(const std::function<Status(const Entry&)>& take) const;

  /// Adds a line in one write. Errors: unwritable.
  [[nodiscard]] Status append(const Entry& entry);

  /// Reads the journals once more, which other shards may have added to.
  [[nodiscard]] Status refresh();

 private:
  struct Place {
    std::size_t journal = 0;
    std::uint64_t offset = 0, bytes = 0;
    double ended_s = 0.0;
  };
  class Files;
  explicit Results(std::string folder);
  [[nodiscard]] Status index(std::size_t journal);
  [[nodiscard]] std::optional<Entry> at(const Place& place) const;

  std::string folder_;
  std::unique_ptr<Files> files_;
  std::map<std::string, Place, std::less<>> places_;
};

/// "noise-4f1c….csv.json" less its ending: a name in documents/ for a recording with its flags.
[[nodiscard]] std::string document_stem(const Job& job);

/// Makes results.parquet and failures.ndjson of the journals, each of which takes its name when it
/// is whole. One row for each recording and channel: file, the manifest's columns, verb, channel,
/// the figures, reason, flags, document. Memory: of one group of rows. Errors: unwritable,
/// unreadable.
[[nodiscard]] Status write_tables(const std::string& folder);

}  // namespace proofmass::fleet
