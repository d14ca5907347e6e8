#include <algorithm>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "output.hpp"
#include "proofmass/thesis/thesis_report.hpp"
#include "thesis_recordings.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

constexpr double s_per_h = 3600.0;

std::vector<std::string> files_of(const ThesisCommand& command) {
  std::vector<std::string> files;
  if (!command.still.empty()) files.push_back(command.still);
  if (!command.tumble.empty()) files.push_back(command.tumble);
  files.insert(files.end(), command.wheels.begin(), command.wheels.end());
  if (std::ranges::count(files, "-") > 1)
    throw Failure(usage, "standard input can be one recording only: name files");
  return files;
}

}  // namespace

void run(const ThesisCommand& command) {
  thesis::ThesisReport report;
  report.inputs = files_of(command);
  report.seed = command.seed;
  report.runs = command.runs;
  const thesis::OwnRecordings own = own_recordings(command, report.notes);
  report.programme =
      need(thesis::run_programme(own, {.seed = command.seed,
                                       .seeds = command.runs,
                                       .static_duration_s = s_per_h * command.static_hours,
                                       .gravity_mps2 = gravity_mps2(command.input),
                                       .progress = progress_bar(command.output)}),
           Stage::computing);
  finish(thesis::describe(report), {}, command.output);
}

}  // namespace proofmass::app
