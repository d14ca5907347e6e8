#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <tuple>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/provenance.hpp"
#include "fleet/runner.hpp"
#include "proofmass/core/new_file.hpp"
#include "proofmass/core/version.hpp"
#include "proofmass/fleet/pool.hpp"

// Groups of recordings that are analysed as one. What is kept of each recording is in files of the
// folder of results, by which processes and machines share the work:
//   sums/NAME.card  what its place on the grid of all is found from
//   sums/NAME.sums  its sums at that place
namespace proofmass::app {
namespace {

namespace fs = std::filesystem;
using fleet::Job;
using fleet::RecordingSums;

constexpr const char* no_place = "none";

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Name of a recording that a worker has fetched, without that of its temporary copy.
void name_source(const std::string& path, const std::string& file) {
  auto read = fleet::sums_of_text(file_text(path));
  if (!read) return;
  RecordingSums sums = std::move(read).value();
  sums.file = file;
  std::ignore = write_file(path, fleet::text_of(std::move(sums)));
}

}  // namespace

// Key of everything that the sums of a recording depend on, except its bytes and its place.
std::string Run::key_of(const Job& job) const {
  std::string text = std::string(version()) + "\n" + program_commit();
  for (const std::string& flag : verb_flags(job)) {
    text += "\n" + flag;
    std::error_code problem;
    const std::string file = flag.substr(flag.find('=') + 1);
    if (fs::is_regular_file(file, problem)) text += "\n" + sha256_of(file);
  }
  // A word of the same kind as the names of documents.
  const std::string stem = fleet::document_stem(Job{.path = text, .flags = {}, .columns = {}});
  return stem.substr(stem.rfind('-') + 1);
}

std::string Run::sums_path(const Job& job, std::size_t part, const std::string& place) const {
  const Job recording{.path = job.parts[part], .flags = job.flags, .columns = {}};
  const std::string name =
      fleet::document_stem(recording) + (place == no_place ? ".card" : ".sums");
  return (fs::path(command_.into) / "sums" / name).string();
}

// Whether they are there, of this key; of a recording of this shard also of its present bytes.
bool Run::has_sums(std::size_t group, std::size_t part, const std::string& place) const {
  const Job& job = jobs_[group];
  const auto head = fleet::head_of_sums(sums_path(job, part, place));
  if (!head || head->place != place || head->key != key_of(job)) return false;
  const Group& of = groups_[group];
  if (place != no_place && head->sha256 != of.cards[part].sha256) return false;
  return of.own_sha256[part].empty() || of.own_sha256[part] == head->sha256;
}

// Which groups have recordings for this shard, and which of them: every N-th of all.
void Run::keep_groups_of_shard() {
  std::size_t number = 0;
  std::vector<Job> jobs;
  for (Job& job : jobs_) {
    Group group;
    for (std::size_t part = 0; part < job.parts.size(); ++part)
      group.is_own.push_back(number++ % report_.shard.n == report_.shard.i);
    if (std::ranges::none_of(group.is_own, [](bool own) { return own; })) continue;
    group.own_sha256.resize(job.parts.size());
    group.cards.resize(job.parts.size());
    groups_.push_back(std::move(group));
    jobs.push_back(std::move(job));
  }
  jobs_ = std::move(jobs);
  report_.jobs = jobs_.size();
}

// Only where there is something to compare it with.
void Run::hash_own_parts(std::size_t group, bool has_entry) {
  const Job& job = jobs_[group];
  for (std::size_t part = 0; part < job.parts.size(); ++part)
    if (groups_[group].is_own[part] && !is_url(job.parts[part]) &&
        (has_entry || fs::exists(sums_path(job, part, no_place))))
      groups_[group].own_sha256[part] = sha256_of(job.parts[part]);
}

// Those of other shards are their concern.
bool Run::inputs_unchanged(std::size_t group, const fleet::Entry& entry) const {
  const std::vector<std::string>& parts = jobs_[group].parts;
  const Group& of = groups_[group];
  return std::ranges::all_of(entry.inputs, [&](const fleet::InputSum& input) {
    if (is_url(input.path)) return true;
    const auto part =
        static_cast<std::size_t>(std::ranges::find(parts, input.path) - parts.begin());
    if (part == parts.size()) return input.sha256 == sha256_of(input.path);
    return !of.is_own[part] || input.sha256 == of.own_sha256[part];
  });
}

void Run::find_groups() {
  keep_groups_of_shard();
  for (std::size_t k = 0; k < jobs_.size() && !interruption_waits(); ++k) {
    const auto entry = results_.find(jobs_[k].id());
    hash_own_parts(k, static_cast<bool>(entry));
    if (!entry || !is_current(jobs_[k], *entry)) continue;
    groups_[k].is_done = inputs_unchanged(k, *entry);
    if (groups_[k].is_done) count_skipped(jobs_[k], *entry);
  }
}

// Those of this shard, or of the others, which may have made theirs meanwhile.
std::vector<std::size_t> Run::cards_to_make(bool own) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < jobs_.size(); ++k)
    for (std::size_t part = 0; part < jobs_[k].parts.size() && !groups_[k].is_done; ++part)
      if (groups_[k].is_own[part] == own &&
          ((own && command_.force) || !has_sums(k, part, no_place)))
        order.push_back(
            add_task({.kind = Task::Kind::sums, .job = k, .part = part, .place = no_place}));
  largest_first(order);
  return order;
}

void Run::place_recordings() {
  for (std::size_t k = 0; k < jobs_.size(); ++k) {
    Group& group = groups_[k];
    const Job& job = jobs_[k];
    for (std::size_t part = 0; part < job.parts.size() && !group.is_done; ++part) {
      const std::string path = sums_path(job, part, no_place);
      auto card = fleet::sums_of_text(file_text(path));
      if (card)
        group.cards[part] = std::move(card).value();
      else
        fail_group(k, path + ": " + card.error().message, bad_input);
    }
    if (group.is_done) continue;
    auto places = fleet::places_of(group.cards, job.starts_s);
    if (places)
      group.places = std::move(places).value();
    else
      fail_group(k, places.error().message, usage);
  }
}

std::vector<std::size_t> Run::sums_to_make() {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < jobs_.size(); ++k)
    for (std::size_t part = 0; part < jobs_[k].parts.size() && !groups_[k].is_done; ++part) {
      const std::string place = groups_[k].places[part].word();
      if (groups_[k].is_own[part] && (command_.force || !has_sums(k, part, place)))
        order.push_back(
            add_task({.kind = Task::Kind::sums, .job = k, .part = part, .place = place}));
    }
  largest_first(order);
  return order;
}

// Those whose sums are complete. The last shard to end finds all of them.
std::vector<std::size_t> Run::groups_to_join() {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < jobs_.size(); ++k) {
    if (groups_[k].is_done) continue;
    std::size_t there = 0;
    while (there < jobs_[k].parts.size() && has_sums(k, there, groups_[k].places[there].word()))
      ++there;
    if (there == jobs_[k].parts.size())
      order.push_back(add_task({.kind = Task::Kind::join, .job = k}));
    else
      ++report_.waiting;
  }
  return order;
}

bool Run::sums_ended(const fleet::Ended& ended) {
  const Task& task = tasks_[ended.job];
  const Job& job = jobs_[task.job];
  const std::string& file = job.parts[task.part];
  std::error_code problem;
  if (ended.status == done && ended.signal == 0) {
    if (is_url(file)) name_source(output_of(task), file);
    fs::rename(output_of(task), sums_path(job, task.part, task.place), problem);
    if (!problem) return false;
  }
  fs::remove(output_of(task), problem);
  const bool is_lasting = ended.signal == 0 && (ended.status == bad_input || ended.status == usage);
  if (!is_lasting && retried_.insert(ended.job).second) return true;
  if (!groups_[task.job].is_done)
    fail_group(task.job, file + ": " + why_it_failed(file, ended, command_.timeout_s),
               is_lasting ? ended.status : static_cast<int>(failed));
  return false;
}

void Run::fail_group(std::size_t group, const std::string& reason, int status) {
  groups_[group].is_done = true;
  fleet::Ended ended;
  ended.status = status;
  ended.words = "proofmass: " + reason;
  take_result(jobs_[group], entry_of(jobs_[group], ended));
}

Status Run::run_groups() {
  std::error_code problem;
  fs::create_directories(fs::path(command_.into) / "sums", problem);
  if (problem)
    return Error{Errc::unwritable, command_.into + "/sums: cannot be made: " + problem.message()};
  find_groups();
  for (const bool own : {true, false})
    if (const Status ran = run_tasks(cards_to_make(own)); !ran) return ran;
  if (interruption_waits()) return Done{};
  place_recordings();
  if (const Status ran = run_tasks(sums_to_make()); !ran) return ran;
  if (interruption_waits()) return Done{};
  // Joining takes little time and needs the files here, so this process does it.
  const std::vector<std::size_t> order = groups_to_join();
  return order.empty() ? Status(Done{}) : run_here(order);
}

}  // namespace proofmass::app
