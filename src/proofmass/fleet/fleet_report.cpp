#include "proofmass/fleet/fleet_report.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/report/document.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::fleet {

std::string fleet_text(const FleetReport& report) {
  constexpr std::size_t most_listed = 20;
  std::string text = fmt::format(
      "{} of {}: {} done, {} skipped, {} failed, in {} with {}\n",
      report::count_words(report.jobs, "recording"), report.manifest, report.done, report.skipped,
      report.failed.size(), report::duration_words(report.elapsed_s),
      report.processes == 1 ? "1 process" : fmt::format("{} processes", report.processes));
  if (report.shard.n > 1)
    text += fmt::format("Shard {} of {}, counted from 0.\n", report.shard.i, report.shard.n);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < std::min(report.failed.size(), most_listed); ++k)
    rows.push_back({report.failed[k].file, report.failed[k].reason});
  if (!rows.empty()) text += "\nFailed\n" + report::aligned(rows);
  if (report.failed.size() > most_listed)
    text += fmt::format("  and {} more\n", report.failed.size() - most_listed);
  return text + "\n" +
         report::aligned({{"results", report.folder + "/results.parquet"},
                          {"failures", report.folder + "/failures.ndjson"},
                          {"documents", report.folder + "/documents/"}});
}

std::string fleet_json(const FleetReport& report) {
  using report::Array;
  using report::Object;
  Array failed;
  for (const FailedJob& job : report.failed)
    failed.push_back(Object{{"file", job.file}, {"reason", job.reason}});
  return report::to_json(
      {"fleet", {report.manifest}, report::texts(report.notes, Severity::warning)},
      {{"analysis", report.analysis},
       {"jobs", std::uint64_t{report.jobs}},
       {"done", std::uint64_t{report.done}},
       {"skipped", std::uint64_t{report.skipped}},
       {"failed", std::move(failed)},
       {"results", report.folder},
       {"shard",
        Object{{"i", std::uint64_t{report.shard.i}}, {"n", std::uint64_t{report.shard.n}}}},
       {"processes", std::uint64_t{report.processes}},
       {"elapsed_s", report.elapsed_s},
       {"busy_s", report.busy_s}});
}

}  // namespace proofmass::fleet
