#include "fleet/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <thread>
#include <tuple>
#include <unistd.h>

#include "cli/command_line.hpp"
#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/provenance.hpp"
#include "cli/run_command.hpp"
#include "fleet/runner.hpp"
#include "fleet/shard.hpp"
#include "input/input.hpp"
#include "proofmass/core/version.hpp"
#include "proofmass/fleet/driver.hpp"
#include "proofmass/fleet/figures.hpp"
#include "proofmass/fleet/pool.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::app {
namespace {

namespace fs = std::filesystem;
using fleet::Entry;
using fleet::FleetReport;
using fleet::Job;

constexpr double bytes_per_megabyte = 1e6;

std::size_t processors() {
  return std::max(1U, std::thread::hardware_concurrency());
}

double free_memory_mb() {
  std::ifstream file("/proc/meminfo");
  constexpr double usual_mb = 2048.0;
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("MemAvailable:")) return std::stod(line.substr(13)) * 1024.0 / 1e6;
  return usual_mb;
}

std::string text_in(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> files_of_job(const Job& job) {
  return job.parts.empty() ? std::vector{job.path} : job.parts;
}

}  // namespace

bool is_url(const std::string& path) {
  return path.find("://") != std::string::npos;
}

Run::Run(const FleetCommand& command,
         std::vector<Job> jobs,
         fleet::Results results,
         fleet::Shard shard)
    : command_(command),
      jobs_(std::move(jobs)),
      results_(std::move(results)),
      panel_(command.output) {
  report_.manifest = command.manifest;
  report_.analysis = command.verb;
  report_.folder = command.into;
  report_.jobs = jobs_.size();
  report_.shard = shard;
  report_.dask = command.dask;
  share_memory();
}

// Divides the memory among local processes; that of remote workers is limited only by --memory.
void Run::share_memory() {
  constexpr double least_mb = 64.0, share_of_free = 0.75;
  const bool here = command_.dask.empty();
  report_.processes = here ? command_.processes.value_or(processors()) : 0;
  const auto sharers = static_cast<double>(here ? report_.processes : 1);
  const double all_mb = command_.memory_mb.value_or(here ? share_of_free * free_memory_mb() : 0.0);
  memory_mb_ = all_mb / sharers;
  if (memory_mb_ < least_mb && (here || command_.memory_mb))
    throw Failure(usage, fmt::format("--memory: {} MB for {:.0f} processes: each needs {} at least",
                                     report::compact(all_mb, 3), sharers, least_mb));
}

std::vector<std::string> Run::verb_flags(const Job& job) const {
  return fleet::merged_flags(command_.flags, job.flags);
}

std::vector<std::string> Run::flags_of(const Job& job) const {
  std::vector<std::string> flags = verb_flags(job);
  if (job.parts.empty()) return flags;
  flags.emplace_back("--as-one");
  if (!job.starts_s.empty())
    flags.push_back(fmt::format("--starts={}", fmt::join(job.starts_s, ",")));
  return flags;
}

std::string Run::part_of(const Job& job) const {
  return (fs::path(command_.into) / (document_of(job) + ".part-" + std::to_string(report_.shard.i)))
      .string();
}

std::vector<std::string> Run::arguments_of(const Task& task) const {
  const Job& job = jobs_[task.job];
  std::vector<std::string> arguments{"proofmass", command_.verb};
  const auto add = [&](const std::vector<std::string>& words) {
    arguments.insert(arguments.end(), words.begin(), words.end());
  };
  if (task.kind == Task::Kind::sums) {
    arguments.push_back(job.parts[task.part]);
    add(verb_flags(job));
    add({"--sums", key_of(job) + "/" + task.place, "--quiet"});
    return arguments;
  }
  if (task.kind == Task::Kind::join) {
    for (std::size_t part = 0; part < job.parts.size(); ++part)
      arguments.push_back(sums_path(job, part, groups_[task.job].places[part].word()));
    add(verb_flags(job));
    arguments.emplace_back("--as-one");
  } else {
    arguments.push_back(job.path);
    add(flags_of(job));
  }
  add({"--quiet", "--json", "-"});
  if (command_.reports)
    add({"--report",
         (fs::path(command_.into) / "reports" / (fleet::document_stem(job) + ".html")).string()});
  // The analysis copies a table that is kept whole; a larger one is read in pieces.
  if (memory_mb_ > 0.0 && (command_.verb == "inspect" || command_.verb == "noise")) {
    constexpr double copies = 4.0;
    add({"--memory", fmt::format("{:.0f}", memory_mb_ / copies)});
  }
  return arguments;
}

std::string Run::output_of(const Task& task) const {
  const Job& job = jobs_[task.job];
  if (task.kind != Task::Kind::sums) return part_of(job);
  return sums_path(job, task.part, task.place) + ".part-" + std::to_string(report_.shard.i);
}

// True if flags and program are unchanged since the result, which is there.
bool Run::is_current(const Job& job, const Entry& entry) const {
  if (command_.force || entry.verb != command_.verb || entry.flags != flags_of(job) ||
      entry.parts != job.parts || entry.version != version() || entry.commit != program_commit() ||
      (!entry.failure.empty() && !entry.is_lasting))
    return false;
  const bool has_document =
      !entry.failure.empty() || fs::exists(fs::path(command_.into) / entry.document);
  const bool lacks_report = command_.reports && entry.failure.empty() && entry.report.empty();
  return has_document && !lacks_report;
}

void Run::count_skipped(const Job& job, Entry entry) {
  if (entry.columns != job.columns) {
    entry.columns = job.columns;
    keep(entry);
  }
  if (entry.failure.empty())
    ++report_.skipped;
  else
    report_.failed.push_back({job.path, entry.failure});
}

// True if also the inputs (including sensor files) are unchanged since the last run.
bool Run::is_done_already(const Job& job) {
  const auto entry = results_.find(job.id());
  if (!entry || !is_current(job, *entry)) return false;
  for (const fleet::InputSum& input : entry->inputs)
    if (!is_url(input.path) && input.sha256 != sha256_of(input.path)) return false;
  count_skipped(job, *entry);
  return true;
}

std::size_t Run::add_task(Task task) {
  std::error_code problem;
  const Job& job = jobs_[task.job];
  std::uintmax_t bytes = 0;
  if (task.kind == Task::Kind::verb) bytes = fs::file_size(job.path, problem);
  if (task.kind == Task::Kind::sums) bytes = fs::file_size(job.parts[task.part], problem);
  bytes_.push_back(problem ? 0 : bytes);
  bytes_to_do_ += bytes_.back();
  ++to_do_;
  tasks_.push_back(std::move(task));
  return tasks_.size() - 1;
}

void Run::largest_first(std::vector<std::size_t>& order) const {
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return bytes_[a] > bytes_[b]; });
}

std::vector<std::size_t> Run::plan() {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < jobs_.size() && !interruption_waits(); ++k)
    if (!is_done_already(jobs_[k])) order.push_back(add_task({.job = k}));
  largest_first(order);
  return order;
}

int Run::run_child(const Task& task) const {
  std::vector<std::string> arguments = arguments_of(task);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  return run_command(static_cast<int>(arguments.size()), words.data());
}

namespace {

// The last line of the verb's standard error, without the program's name.
std::string last_words(const std::string& words) {
  constexpr std::string_view name = "proofmass: ";
  const std::size_t at = words.rfind(name);
  if (at == std::string::npos) return io::clean_text(words.substr(0, words.find('\n')));
  const std::size_t from = at + name.size();
  return words.substr(from, words.find('\n', from) - from);
}

}  // namespace

std::string why_it_failed(const std::string& file,
                          const fleet::Ended& ended,
                          const std::optional<double>& timeout_s) {
  if (ended.timed_out)
    return fmt::format("took longer than {} s (--timeout)",
                       report::compact(timeout_s.value_or(0.0), 4));
  if (ended.signal != 0)
    return fmt::format("its process was ended by signal {} ({})", ended.signal,
                       ::strsignal(ended.signal));
  std::string words = last_words(ended.words);
  if (words.starts_with(file + ": ")) words.erase(0, file.size() + 2);
  return words.empty() ? fmt::format("ended with status {}", ended.status) : words;
}

void Run::read_document(const Job& job, Entry& entry) const {
  const std::string stem = fleet::document_stem(job);
  entry.document = document_of(job);
  const std::string path = (fs::path(command_.into) / entry.document).string();
  std::error_code problem;
  fs::rename(part_of(job), path, problem);
  auto found = fleet::rows_of_document(text_in(path));
  if (!found) {
    entry.failure = entry.document + ": " + found.error().message;
    return;
  }
  fleet::DocumentRows rows = std::move(found).value();
  entry.rows = std::move(rows.rows);
  entry.inputs = std::move(rows.inputs);
  if (command_.reports) entry.report = "reports/" + stem + ".html";
}

Entry Run::entry_of(const Job& job, const fleet::Ended& ended) const {
  Entry entry;
  entry.verb = command_.verb;
  entry.path = job.path;
  entry.own_flags = job.flags;
  entry.flags = flags_of(job);
  entry.columns = job.columns;
  entry.parts = job.parts;
  entry.version = version();
  entry.commit = program_commit();
  entry.seconds = ended.seconds;
  if (ended.status == done && ended.signal == 0)
    read_document(job, entry);
  else
    entry.failure = why_it_failed(job.path, ended, command_.timeout_s);
  if (!entry.failure.empty()) {
    entry.is_lasting = ended.status == bad_input || ended.status == usage;
    for (const std::string& file : files_of_job(job))
      entry.inputs.push_back({file, sha256_of(file)});
    entry.document.clear();
    std::error_code problem;
    fs::remove(fs::path(command_.into) / document_of(job), problem);
    fs::remove(part_of(job), problem);
  }
  return entry;
}

void Run::keep(const Entry& entry) {
  Entry stamped = entry;
  stamped.ended_s =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  const Status added = results_.append(stamped);
  if (!added) throw Failure(failed, added.error());
}

bool Run::ended(const fleet::Ended& ended) {
  report_.busy_s += ended.seconds;
  const bool again =
      tasks_[ended.job].kind == Task::Kind::sums ? sums_ended(ended) : verb_ended(ended);
  if (again) return true;
  ++ended_;
  bytes_done_ += bytes_[ended.job];
  return false;
}

bool Run::verb_ended(const fleet::Ended& ended) {
  const Job& job = jobs_[tasks_[ended.job].job];
  const Entry entry = entry_of(job, ended);
  // Crashes, timeouts and lack of memory may be due to other jobs and are retried once; a refusal
  // is final.
  if (!entry.failure.empty() && !entry.is_lasting && retried_.insert(ended.job).second) return true;
  take_result(job, entry);
  return false;
}

void Run::take_result(const Job& job, const Entry& entry) {
  keep(entry);
  if (entry.failure.empty()) {
    ++report_.done;
    return;
  }
  report_.failed.push_back({job.path, entry.failure});
  panel_.wipe();
  show_line("failed: " + io::clean_text(job.path + ": " + entry.failure), command_.output);
}

void Run::show(std::size_t running) {
  if (!panel_.is_shown()) return;
  constexpr double width = 30.0, soonest_s = 2.0;
  const double share = bytes_to_do_ == 0
                           ? 0.0
                           : static_cast<double>(bytes_done_) / static_cast<double>(bytes_to_do_);
  const double gone_s = std::chrono::duration<double>(Clock::now() - begun_).count();
  const auto full = static_cast<std::size_t>(share * width);
  std::string line =
      fmt::format("[{}{}] {} of {} recordings, {} running, {} failed", std::string(full, '='),
                  std::string(30 - full, ' '), ended_, to_do_, running, report_.failed.size());
  if (share > 0.0 && gone_s > soonest_s)
    line += ", " + report::duration_words(std::ceil(gone_s * (1.0 - share) / share)) + " left";
  panel_.show({line});
}

bool Run::goes_on(std::size_t running) {
  show(running);
  return !interruption_waits();
}

void Run::write_tables() {
  const Status written = fleet::write_tables(command_.into);
  if (!written) throw Failure(status_of(written.error(), Stage::writing), written.error());
}

Status Run::run_here(const std::vector<std::size_t>& order) {
  // A child inherits locks held by other threads, which are never released there: the thread that
  // computes the checksums has to end before the first fork.
  if (command_.output.invocation) std::ignore = command_.output.invocation->provenance();
  return fleet::run_pool(
      order,
      {.processes = std::max<std::size_t>(1, report_.processes),  // 0: the workers of Dask
       .timeout_s = command_.timeout_s.value_or(0.0),
       .memory_bytes = static_cast<std::size_t>(memory_mb_ * bytes_per_megabyte)},
      {.run = [&](std::size_t job) { return run_child(tasks_[job]); },
       .output = [&](std::size_t job) { return output_of(tasks_[job]); },
       .ended = [&](const fleet::Ended& one) { return ended(one); },
       .goes_on = [&](std::size_t running) { return goes_on(running); }});
}

Status Run::run_by_dask(const std::vector<std::size_t>& order) {
  ignore_broken_pipes();
  const char* python = std::getenv("PROOFMASS_PYTHON");
  const fleet::DriverOptions options{
      .command = {python == nullptr ? "python3" : python, "-m", "proofmass._dask", command_.dask},
      .program = command_.program,
      .timeout_s = command_.timeout_s.value_or(0.0),
      .memory_bytes = static_cast<std::size_t>(memory_mb_ * bytes_per_megabyte)};
  const Status ran =
      fleet::run_driver(order, options,
                        {.arguments =
                             [&](std::size_t job) {
                               std::vector<std::string> words = arguments_of(tasks_[job]);
                               words.erase(words.begin());  // the program
                               return words;
                             },
                         .output = [&](std::size_t job) { return output_of(tasks_[job]); },
                         .ended = [&](const fleet::Ended& one) { return ended(one); },
                         .goes_on = [&](std::size_t running) { return goes_on(running); }});
  return ran ? ran : Status(ran.error().at("--dask"));
}

Status Run::run_tasks(const std::vector<std::size_t>& order) {
  if (order.empty() || interruption_waits()) return Done{};
  return command_.dask.empty() ? run_here(order) : run_by_dask(order);
}

FleetReport Run::finish() {
  if (command_.reports) fs::create_directories(fs::path(command_.into) / "reports");
  const Status ran = command_.by.empty() ? run_tasks(plan()) : run_groups();
  panel_.wipe();
  write_tables();
  if (!ran) throw Failure(failed, ran.error());
  report_.elapsed_s = std::chrono::duration<double>(Clock::now() - begun_).count();
  std::ranges::sort(report_.failed, {}, &fleet::FailedJob::file);
  if (interruption_waits())
    show_line(fmt::format("{} of {} recordings are done; the same command goes on from there",
                          report_.done + report_.skipped + report_.failed.size(), report_.jobs),
              command_.output);
  return report_;
}

namespace {

// Parses one recording's command line completely, so that a usage error ends the fleet before it
// begins.
void check_flags(const FleetCommand& command, const std::vector<std::string>& flags) {
  for (const std::string& flag : flags)
    for (const char* one_for_all : {"--output", "-o", "--update-sensor"})
      if (flag.substr(0, flag.find('=')) == one_for_all)
        throw Failure(usage, flag + " names one file for all recordings: leave it out");
  std::vector<std::string> arguments{"proofmass", command.verb, command.manifest};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  [[maybe_unused]] const auto parsed =
      parse_command_line(static_cast<int>(arguments.size()), words.data());
}

}  // namespace

FleetReport run_fleet(const FleetCommand& command) {
  if (command.into.empty())
    throw Failure(usage, "--into: required: the folder that the results go to");
  const fleet::Shard shard = parse_shard(command.shard);
  std::vector<Job> jobs =
      need(fleet::read_manifest(command.manifest, duckdb_library()), Stage::reading);
  if (!command.by.empty()) {
    if (command.verb != "noise") throw Failure(usage, "--by: of noise alone");
    jobs = need(fleet::grouped_by(jobs, command.by), Stage::reading);
  }
  std::set<std::vector<std::string>> seen;
  for (const Job& job : jobs)
    if (seen.insert(job.flags).second)
      check_flags(command, fleet::merged_flags(command.flags, job.flags));
  if (shard.n > 1 && command.by.empty()) jobs = fleet::shard_of(jobs, shard.i, shard.n);
  fleet::Results results = need(fleet::Results::open(command.into, shard), Stage::writing);
  FleetReport report;
  without_interruption(
      [&] { report = Run(command, std::move(jobs), std::move(results), shard).finish(); });
  return report;
}

}  // namespace proofmass::app
