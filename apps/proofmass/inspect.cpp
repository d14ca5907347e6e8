#include <algorithm>
#include <deque>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "output.hpp"
#include "proofmass/report/inspect_report.hpp"
#include "proofmass/signal/audit.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

// What is in the file as it is; in m/s^2 only where a sensor file says how.
std::vector<Recording> load_all(const InspectCommand& command, std::vector<Note>& notes) {
  std::vector<Recording> recordings;
  for (const std::string& file : command.files) {
    recordings.push_back(load(file, command.input, progress_bar(command.output)));
  }
  const auto models = load_sensors(command.input, notes);
  if (!models.empty()) calibrate(models, accelerometers(recordings), recordings);
  return recordings;
}

}  // namespace

void run(const InspectCommand& command) {
  std::vector<Note> sensor_notes;
  const std::vector<Recording> recordings = load_all(command, sensor_notes);
  show_notes(sensor_notes, "", command.output);
  std::deque<signal::RecordingAudit> audits;
  std::vector<report::InspectedFile> files;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    audits.push_back(signal::audit(recordings[k]));
    files.push_back({command.files[k], recordings[k], audits.back()});
  }
  publish({.text =
               [&] {
                 std::string text;
                 for (const auto& file : files)
                   text += (text.empty() ? "" : "\n") + inspect_text(file);
                 return text;
               },
           .json = [&] { return report::inspect_json(files); },
           .html = [&] { return report::inspect_html(files); }},
          command.output);
  hold_to_strict(command.output, std::any_of(audits.begin(), audits.end(),
                                             [](const auto& audit) { return audit.is_bad(); }));
}

}  // namespace proofmass::app
