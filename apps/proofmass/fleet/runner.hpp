#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/console.hpp"
#include "fleet/command.hpp"
#include "proofmass/fleet/fleet_report.hpp"
#include "proofmass/fleet/manifest.hpp"
#include "proofmass/fleet/noise_sums.hpp"
#include "proofmass/fleet/pool.hpp"
#include "proofmass/fleet/results.hpp"

namespace proofmass::app {

/// An object in remote storage; changes of its content are not detected.
[[nodiscard]] bool is_url(const std::string& path);

/// One run of a fleet.
class Run {
 public:
  Run(const FleetCommand& command,
      std::vector<fleet::Job> jobs,
      fleet::Results results,
      fleet::Shard shard);

  fleet::FleetReport finish();

 private:
  using Clock = std::chrono::steady_clock;

  /// One process.
  struct Task {
    enum class Kind {
      verb,  ///< the verb for a recording
      sums,  ///< what is kept of one recording of a group
      join,  ///< the verb for a group, of the sums of its recordings
    };
    Kind kind = Kind::verb;
    std::size_t job = 0;
    std::size_t part = 0;    ///< of a group
    std::string place = {};  ///< of the sums; "none": not known yet
  };

  /// Recordings of one sensor: what is known of each.
  struct Group {
    bool is_done = false;      ///< before this run, or in it, or failed
    std::vector<bool> is_own;  ///< whether this shard has to make the sums of a part
    std::vector<std::string> own_sha256;
    std::vector<fleet::RecordingSums> cards;
    std::vector<fleet::SumsPlace> places;
  };

  [[nodiscard]] std::vector<std::string> verb_flags(const fleet::Job& job) const;
  [[nodiscard]] std::vector<std::string> flags_of(const fleet::Job& job) const;
  /// Path relative to the folder of results.
  [[nodiscard]] static std::string document_of(const fleet::Job& job) {
    return "documents/" + fleet::document_stem(job) + ".json";
  }
  [[nodiscard]] std::string part_of(const fleet::Job& job) const;
  [[nodiscard]] std::vector<std::string> arguments_of(const Task& task) const;
  [[nodiscard]] std::string output_of(const Task& task) const;
  [[nodiscard]] bool is_current(const fleet::Job& job, const fleet::Entry& entry) const;
  void count_skipped(const fleet::Job& job, fleet::Entry entry);
  [[nodiscard]] bool is_done_already(const fleet::Job& job);
  [[nodiscard]] int run_child(const Task& task) const;
  [[nodiscard]] fleet::Entry entry_of(const fleet::Job& job, const fleet::Ended& ended) const;
  void read_document(const fleet::Job& job, fleet::Entry& entry) const;
  [[nodiscard]] bool ended(const fleet::Ended& ended);
  [[nodiscard]] bool verb_ended(const fleet::Ended& ended);
  [[nodiscard]] bool sums_ended(const fleet::Ended& ended);
  void take_result(const fleet::Job& job, const fleet::Entry& entry);
  [[nodiscard]] bool goes_on(std::size_t running);
  void keep(const fleet::Entry& entry);
  void show(std::size_t running);
  [[nodiscard]] std::vector<std::size_t> plan();
  [[nodiscard]] std::size_t add_task(Task task);
  void largest_first(std::vector<std::size_t>& order) const;
  void share_memory();
  [[nodiscard]] Status run_tasks(const std::vector<std::size_t>& order);
  [[nodiscard]] Status run_here(const std::vector<std::size_t>& order);
  [[nodiscard]] Status run_by_dask(const std::vector<std::size_t>& order);
  void write_tables();

  // Groups (groups.cpp).
  [[nodiscard]] Status run_groups();
  void find_groups();
  void keep_groups_of_shard();
  void hash_own_parts(std::size_t group, bool has_entry);
  [[nodiscard]] bool inputs_unchanged(std::size_t group, const fleet::Entry& entry) const;
  [[nodiscard]] std::string key_of(const fleet::Job& job) const;
  [[nodiscard]] std::string sums_path(const fleet::Job& job,
                                      std::size_t part,
                                      const std::string& place) const;
  [[nodiscard]] bool has_sums(std::size_t group, std::size_t part, const std::string& place) const;
  [[nodiscard]] std::vector<std::size_t> cards_to_make(bool own);
  void place_recordings();
  [[nodiscard]] std::vector<std::size_t> sums_to_make();
  [[nodiscard]] std::vector<std::size_t> groups_to_join();
  void fail_group(std::size_t group, const std::string& reason, int status);

  const FleetCommand& command_;
  std::vector<fleet::Job> jobs_;
  std::vector<std::uintmax_t> bytes_;
  std::vector<Task> tasks_;
  std::vector<Group> groups_;
  fleet::Results results_;
  fleet::FleetReport report_;
  std::set<std::size_t> retried_;
  std::uintmax_t bytes_to_do_ = 0, bytes_done_ = 0;
  std::size_t to_do_ = 0, ended_ = 0;
  double memory_mb_ = 0.0;
  Clock::time_point begun_ = Clock::now();
  Panel panel_;
};

/// The reason of a failure, without the name of the recording where that is known.
[[nodiscard]] std::string why_it_failed(const std::string& file,
                                        const fleet::Ended& ended,
                                        const std::optional<double>& timeout_s);

}  // namespace proofmass::app
