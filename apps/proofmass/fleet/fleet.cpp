#include <filesystem>
#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "fleet/run.hpp"
#include "proofmass/fleet/summary.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

namespace fs = std::filesystem;

void add_fleet_flags(CLI::App& verb, FleetCommand& command) {
  verb.add_option("VERB", command.verb,
                  "inspect, noise, drift, calibrate, wheel, track or tilt; or summary, of results")
      ->type_name("WORD")
      ->check(CLI::IsMember(
          {"inspect", "noise", "drift", "calibrate", "wheel", "track", "tilt", "summary"}))
      ->required();
  verb.add_option(
          "MANIFEST", command.manifest,
          "table of recordings (.csv, .ndjson or .parquet: path, flags, sensor, temperature, "
          "date, …), or a folder of them; of summary the results")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Fleet");
  };
  add("--into", command.into, "FOLDER", "of the results; what is there already is not done again");
  add("-j,--jobs", command.processes, "N", "processes at once (default: the processors)")
      ->check(CLI::Range(1, 4096));
  add("--memory", command.memory_mb, "MB",
      "for all processes together (default: three quarters of what is free)")
      ->check(positive());
  add("--timeout", command.timeout_s, "S", "a recording that takes longer is ended (default: none)")
      ->check(positive());
  verb.add_flag("--force", command.force, "do again what is there already")->group("Fleet");
  verb.add_flag("--reports", command.reports, "write a page for each recording, too")
      ->group("Fleet");
  add("--shard", command.shard, "I/N",
      "do every N-th recording, from the I-th on, counted from 0 (default: by the variables of "
      "SLURM, Kubernetes, AWS Batch or MPI; N alone takes I from them)");
  add("--by", command.by, "COLUMN",
      "analyse the recordings with one value in this column of the manifest (sensor) as one with "
      "gaps; of noise");
  CLI::Option* dask =
      add("--dask", command.dask, "ADDRESS",
          "submit the recordings to this Dask scheduler (tcp://host:8786), whose workers do them");
  add("--program", command.program, "FILE",
      "the program on the workers (default: proofmass on their PATH)")
      ->needs(dask);
  const auto of_summary = [&verb](const char* name, auto& into, const char* type,
                                  const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Summary");
  };
  of_summary("--limit", command.limits, "LIMIT",
             "\"white<2e-3\": the yield, by the mean of each sensor; may be repeated")
      ->allow_extra_args(false);
  of_summary("--false-share", command.false_share, "SHARE",
             "of the sensors called out of family, expected to be so by chance (default 0.05)")
      ->check(number("a number between 0 and 1", [](double x) { return x > 0.0 && x < 1.0; }));
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "All other flags are the verb's, for every recording.\n\n"
      "Examples:\n  proofmass fleet noise recordings/ --rate 100 --unit g --into results\n"
      "  proofmass fleet summary results --report summary.html");
}

fleet::SummaryOptions summary_options(const FleetCommand& command) {
  fleet::SummaryOptions options;
  options.false_share = command.false_share;
  for (const std::string& limit : command.limits)
    options.limits.push_back(need(fleet::parse_limit(limit), Stage::reading));
  return options;
}

// Relative link from the page's folder to the results: "" or a path with a final slash.
std::string links_to(const std::string& folder, const std::string& page) {
  std::error_code problem;
  const fs::path from = fs::absolute(page, problem).parent_path();
  const fs::path way = fs::absolute(folder, problem).lexically_relative(from);
  return way.empty() || way == "." ? "" : way.string() + "/";
}

// Also writes the tables, with the results of all shards so far.
void run_summary(const FleetCommand& command) {
  const fleet::Summary summary =
      need(fleet::summarise(command.manifest, summary_options(command)), Stage::reading);
  const Status written = fleet::write_tables(command.manifest);
  if (!written) throw Failure(status_of(written.error(), Stage::writing), written.error());
  finish(fleet::describe(summary, links_to(command.manifest, command.output.report)), {},
         command.output);
}

void run_fleet_verb(const FleetCommand& command) {
  if (command.verb == "summary") return run_summary(command);
  const fleet::FleetReport report = run_fleet(command);
  finish(fleet::describe(report), {}, command.output);
  if (report.jobs > 0 && report.failed.size() == report.jobs)
    throw Failure(bad_input, "no recording could be analysed: " + report.failed.front().file +
                                 ": " + report.failed.front().reason);
}

}  // namespace

Verb fleet_verb() {
  return make_verb<FleetCommand>(
      {.name = fleet_name,
       .group = "Many recordings",
       .help = "a verb for many recordings, and what they show together"},
      add_fleet_flags, run_fleet_verb);
}

}  // namespace proofmass::app
