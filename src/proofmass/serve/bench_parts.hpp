#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/io/pyramid.hpp"
#include "proofmass/serve/bench.hpp"
#include "proofmass/serve/job_queue.hpp"
#include "proofmass/serve/view/file.hpp"

// The parts of a Bench: each guards what it holds by a lock of its own.
namespace proofmass::serve {

using Json = nlohmann::ordered_json;

/// A document as an answer; what is not UTF-8 in it becomes U+FFFD.
[[nodiscard]] Response json_response(const Json& json, unsigned status = 200);

[[nodiscard]] const char* name_of(JobState state);

/// The last line of a run that failed, or what else ended it: "noise crashed (signal 11)".
[[nodiscard]] std::string why_it_failed(const JobStatus& status);

/// What all parts need.
struct BenchShared {
  explicit BenchShared(BenchOptions given)
      : options(std::move(given)), jobs(options.jobs_at_a_time) {}

  /// The program with these arguments, in the folder that is served.
  [[nodiscard]] ChildCommand command(std::vector<std::string> arguments) const;
  /// A new folder of this name in the work folder. Errors: unwritable.
  [[nodiscard]] Result<std::string> make_folder(const std::string& name) const;

  BenchOptions options;
  JobQueue jobs;
};

/// What `inspect` says of each recording of the folder.
class RecordingList {
 public:
  explicit RecordingList(BenchShared& shared) : shared_(shared) {}
  /// Begins to inspect what is new or has changed.
  [[nodiscard]] Response list();
  [[nodiscard]] Response details(const std::string& name);

 private:
  struct Inspection {
    FolderEntry entry;
    std::uint64_t job = 0;
    std::string folder;
    std::optional<Json> summary{};  ///< once it is done
  };
  Inspection& inspection_of(const FolderEntry& entry);
  Json describe(Inspection& inspection);

  BenchShared& shared_;
  std::mutex mutex_;
  std::map<std::string, Inspection> inspections_;
  std::uint64_t last_ = 0;
};

/// Recordings that are being looked at: the last few of them.
class OpenViews {
 public:
  explicit OpenViews(BenchShared& shared) : shared_(shared) {}
  [[nodiscard]] Response state(const std::string& name);
  [[nodiscard]] Response window(const std::string& name, const Target& target);
  [[nodiscard]] Response figures(const std::string& name, const Target& target);
  [[nodiscard]] Response noise(const std::string& name, const Target& target);

 private:
  struct View {
    std::string name;
    FolderEntry entry;
    std::uint64_t job = 0;
    std::string folder;
    std::shared_ptr<const ViewFile> file{};       ///< once it is complete
    std::shared_ptr<const io::Pyramid> stored{};  ///< what lay beside the recording
  };
  [[nodiscard]] Result<View> view_of(const std::string& name);
  [[nodiscard]] Result<std::shared_ptr<const ViewFile>> complete(const std::string& name);

  BenchShared& shared_;
  std::mutex mutex_;
  std::vector<View> views_;  ///< the one used last at the end
  std::uint64_t last_ = 0;
};

/// Runs of verbs, asked for on the page.
class Analyses {
 public:
  explicit Analyses(BenchShared& shared);
  [[nodiscard]] Response list();
  [[nodiscard]] Response begin(const std::string& body);
  /// `path` is what follows /api/analyses/: "ID" or "ID/result.json".
  [[nodiscard]] Response one(const std::string& method, const std::string& path);

 private:
  struct Analysis {
    std::uint64_t id = 0;
    std::uint64_t job = 0;
    Json asked;  ///< verb, files, options
    std::string command, folder;
  };
  [[nodiscard]] Json describe(const Analysis& analysis) const;
  [[nodiscard]] Response file(const Analysis& analysis, const std::string& name) const;
  void forget_old();

  BenchShared& shared_;
  nlohmann::json verbs_;
  std::mutex mutex_;
  std::vector<Analysis> analyses_;
  std::uint64_t last_ = 0;
};

}  // namespace proofmass::serve
