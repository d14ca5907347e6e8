#include <fmt/format.h>
#include <utility>

#include "console.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/sensor/sensor_export.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

// A sensor file that lacks what the export needs is an input to put right.
std::string exported(const SensorCommand& command, const sensor::SensorModel& model) {
  sensor::ImuYamlOptions options{.rate_hz = command.rate_hz};
  if (!command.rostopic.empty()) options.rostopic = command.rostopic;
  const Result<std::string> text =
      command.format == "c-header" ? sensor::c_header(model) : sensor::imu_yaml(model, options);
  if (!text) throw Failure(bad_input, text.error().at(command.file).message);
  return *text;
}

// What a person should know: of the file, and of flags that the format has no place for.
std::vector<Note> notes_of(const SensorCommand& command, const sensor::SensorFile& file) {
  std::vector<Note> notes = file.notes;
  if (command.format == "c-header" && (command.rate_hz || !command.rostopic.empty()))
    notes.push_back({Severity::warning, "a C header has no place for --rate and --rostopic"});
  return notes;
}

// Of what was written, or, where standard output is the document's, of the text in it.
std::string document(const SensorCommand& command,
                     const std::vector<Note>& notes,
                     const std::string& text) {
  std::vector<std::string> warnings = report::texts(notes, Severity::warning);
  const std::string& output = command.output.output;
  const bool nowhere = output.empty() && command.output.json == "-";
  if (nowhere) warnings.emplace_back("output: null: no --output; the text stands here alone");
  const std::string place = output.empty() ? "-" : output;
  return report::to_json({"sensor", {command.file}, std::move(warnings)},
                         {{"format", command.format},
                          {"output", nowhere ? report::Value() : report::Value(place)},
                          {"text", text}});
}

}  // namespace

void run(const SensorCommand& command) {
  if (command.output.output == "-" && command.output.json == "-")
    throw Failure(usage, "--output - and --json - cannot both have standard output: name a file");
  const sensor::SensorFile file = need(sensor::read_sensor_file(command.file), Stage::reading);
  const std::string text = exported(command, file.model);
  const std::vector<Note> notes = notes_of(command, file);
  show_notes(notes, "", command.output);
  const std::string& output = command.output.output;
  const bool to_file = !output.empty() && output != "-";
  if (to_file) write_text(output, text);
  if (output == "-") print_out(text);
  publish({.text =
               [&] {
                 return to_file ? fmt::format("{}: written to {}\n", command.format, output) : text;
               },
           .json = [&] { return document(command, notes, text); },
           .html = {}},
          command.output);
}

}  // namespace proofmass::app
