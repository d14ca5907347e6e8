#include <fmt/format.h>

#include "proofmass/fleet/fleet_report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {
namespace {

namespace field = report::field;
using report::Fields;

std::string processes_of(const FleetReport& report) {
  if (!report.dask.empty()) return "the workers of " + report.dask;
  return report.processes == 1 ? "1 process" : fmt::format("{} processes", report.processes);
}

std::string run_conclusion(const FleetReport& report) {
  std::string text = fmt::format("{} of {}: {} done, {} skipped, {} failed, in {} with {}.",
                                 report::count_words(report.jobs, "recording"), report.manifest,
                                 report.done, report.skipped, report.failed.size(),
                                 report::duration_words(report.elapsed_s), processes_of(report));
  if (report.waiting > 0)
    text += fmt::format(" {} {} for the sums of other shards: run those, or this one after them.",
                        report.waiting, report.waiting == 1 ? "waits" : "wait");
  if (report.shard.n > 1)
    text += fmt::format(" Shard {} of {}, counted from 0.", report.shard.i, report.shard.n);
  return text;
}

Fields run_fields(const FleetReport& report) {
  return {
      field::text("analysis", report.analysis, {.meaning = "the verb that was run"}),
      field::count("jobs", report.jobs,
                   {.meaning = "recordings, of this shard: done, skipped and failed, unless it was "
                               "interrupted"}),
      field::count("done", report.done),
      field::count("skipped", report.skipped,
                   {.meaning = "done before with the same bytes, flags and version"}),
      field::count("waiting", report.waiting,
                   {.meaning = "with --by: those whose sums other shards have still to make"}),
      field::records("failed", report.failed,
                     [](const FailedJob& job) {
                       return Fields{field::text("file", job.file),
                                     field::text("reason", job.reason)};
                     }),
      field::text("results", report.folder, {.meaning = "the folder"}),
      field::object("shard", {field::count("i", report.shard.i, {.meaning = "counted from 0"}),
                              field::count("n", report.shard.n, {.meaning = "1: all recordings"})}),
      field::text("dask", report.dask,
                  {.meaning = "address of the scheduler; empty: processes of this machine"}),
      field::count("processes", report.processes,
                   {.meaning = "at once; 0: as many as the workers have"}),
      field::magnitude("elapsed_s", report.elapsed_s),
      field::magnitude("busy_s", report.busy_s, {.meaning = "of all processes together"}),
      field::notes(report.notes)};
}

report::Section failed_section(const FleetReport& report) {
  report::Section section{.heading = "Failed", .on_terminal = true};
  section.tables.push_back(
      {.caption = "", .head = {"Recording", "Reason"}, .rows = {}, .long_list = true});
  for (const FailedJob& job : report.failed)
    section.tables.front().rows.push_back({job.file, job.reason});
  return section;
}

}  // namespace

report::Document describe(const FleetReport& report) {
  report::Document document{
      .page = {.verb = "fleet",
               .title = fmt::format("{} of {}", report.analysis, report.manifest),
               .inputs = {report.manifest},
               .conclusion = run_conclusion(report),
               .key_figures = {{"Results", report.folder + "/results.parquet"},
                               {"Failures", report.folder + "/failures.ndjson"},
                               {"Documents", report.folder + "/documents/"}},
               .notes = report.notes},
      .fields = run_fields(report),
      .bad = !report.failed.empty()};
  if (!report.failed.empty()) document.page.sections.push_back(failed_section(report));
  return document;
}

}  // namespace proofmass::fleet
