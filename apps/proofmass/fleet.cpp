#include <filesystem>

#include "exit_status.hpp"
#include "fleet_run.hpp"
#include "output.hpp"
#include "proofmass/fleet/summary.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

namespace fs = std::filesystem;

fleet::SummaryOptions summary_options(const FleetCommand& command) {
  fleet::SummaryOptions options;
  options.false_share = command.false_share;
  for (const std::string& limit : command.limits)
    options.limits.push_back(need(fleet::parse_limit(limit), Stage::reading));
  return options;
}

// From the page's folder to that of the results, "" or with a slash at its end.
std::string links_to(const std::string& folder, const std::string& page) {
  std::error_code problem;
  const fs::path from = fs::absolute(page, problem).parent_path();
  const fs::path way = fs::absolute(folder, problem).lexically_relative(from);
  return way.empty() || way == "." ? "" : way.string() + "/";
}

std::string summary_page(const FleetCommand& command, const std::string& folder) {
  return fleet::summary_html(
      need(fleet::summarise(folder, summary_options(command)), Stage::reading),
      links_to(folder, command.output.report));
}

// The tables, too: they hold what all shards have done by now.
void run_summary(const FleetCommand& command) {
  const fleet::Summary summary =
      need(fleet::summarise(command.manifest, summary_options(command)), Stage::reading);
  const Status written = fleet::write_tables(command.manifest);
  if (!written) throw Failure(status_of(written.error(), Stage::writing), written.error().message);
  publish({.text = [&] { return fleet::summary_text(summary); },
           .json = [&] { return fleet::summary_json(summary); },
           .html =
               [&] {
                 return fleet::summary_html(summary,
                                            links_to(command.manifest, command.output.report));
               }},
          command.output);
}

}  // namespace

void run(const FleetCommand& command) {
  if (command.verb == "summary") return run_summary(command);
  const fleet::FleetReport report = run_fleet(command);
  publish({.text = [&] { return fleet::fleet_text(report); },
           .json = [&] { return fleet::fleet_json(report); },
           .html = [&] { return summary_page(command, command.into); }},
          command.output);
  if (report.jobs > 0 && report.failed.size() == report.jobs)
    throw Failure(bad_input, "no recording could be analysed: " + report.failed.front().file +
                                 ": " + report.failed.front().reason);
  hold_to_strict(command.output, !report.failed.empty());
}

}  // namespace proofmass::app
