#include "exit_status.hpp"
#include "fleet_run.hpp"
#include "output.hpp"
#include "verbs.hpp"

namespace proofmass::app {

void run(const FleetCommand& command) {
  const fleet::FleetReport report = run_fleet(command);
  publish({.text = [&] { return fleet::fleet_text(report); },
           .json = [&] { return fleet::fleet_json(report); },
           .html = {}},
          command.output);
  if (report.jobs > 0 && report.failed.size() == report.jobs)
    throw Failure(bad_input, "no recording could be analysed: " + report.failed.front().file +
                                 ": " + report.failed.front().reason);
  hold_to_strict(command.output, !report.failed.empty());
}

}  // namespace proofmass::app
