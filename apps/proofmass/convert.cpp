#include <fmt/format.h>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "output.hpp"
#include "proofmass/report/convert_report.hpp"
#include "proofmass/report/document.hpp"
#include "verbs.hpp"

namespace proofmass::app {

void run(const ConvertCommand& command) {
  if (command.output.output == "-" && command.output.json == "-") {
    throw Failure(usage, "--output - and --json - cannot both have standard output: name a file");
  }
  std::vector<Recording> recordings{
      load(command.file, command.input, progress_bar(command.output))};
  std::vector<Note> notes = recordings.front().notes;
  const auto models = load_sensors(command.input, notes);
  if (!models.empty()) calibrate(models, accelerometers(recordings), recordings);
  show_notes(notes, "", command.output);
  write_series(recordings.front(), command.output.output);
  const report::ConvertReport result{command.file, command.output.output, recordings.front(),
                                     notes};
  publish({.text = [&] { return report::convert_text(result); },
           .json = [&] { return report::convert_json(result); },
           .html = {}},
          command.output);
  hold_to_strict(command.output, !report::texts(notes, Severity::bad).empty());
}

}  // namespace proofmass::app
