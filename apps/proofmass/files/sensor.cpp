#include <fmt/format.h>
#include <utility>

#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "proofmass/report/sensor/report.hpp"
#include "proofmass/sensor/sensor_comparison.hpp"
#include "proofmass/sensor/sensor_export.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct SensorCommand {
  std::string action, format, rostopic;
  std::vector<std::string> files;
  std::optional<double> rate_hz;
  OutputFlags output;
};

void add_sensor_flags(CLI::App& verb, SensorCommand& command) {
  verb.add_option("ACTION", command.action, "show FILE, diff OLD NEW, or export FILE")
      ->type_name("")
      ->check(CLI::IsMember({"show", "diff", "export"}))
      ->required();
  verb.add_option("FILE", command.files, "sensor files, TOML")
      ->type_name("")
      ->expected(1, 2)
      ->required();
  verb.add_option("--format", command.format,
                  "export: imu-yaml, for visual-inertial calibration, or c-header, for firmware")
      ->type_name("NAME")
      ->group("Export")
      ->check(CLI::IsMember({"imu-yaml", "c-header"}));
  verb.add_option("--rate", command.rate_hz, "export, imu-yaml: sample rate of the recordings")
      ->type_name("HZ")
      ->group("Export")
      ->check(positive());
  verb.add_option("--rostopic", command.rostopic,
                  "export, imu-yaml: topic of the recordings (default /imu0)")
      ->type_name("NAME")
      ->group("Export");
  verb.add_option("-o,--output", command.output.output,
                  "export: the new file (default: standard output)")
      ->type_name("FILE")
      ->group("Output");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n  proofmass sensor show rim.toml\n"
      "  proofmass sensor diff rim-2025.toml rim.toml --report change.html\n"
      "  proofmass sensor export rim.toml --format imu-yaml --rate 100 -o imu.yaml");
}

// Rejects unused and missing flags and files of the action.
void check(const SensorCommand& command) {
  const bool exports = command.action == "export";
  const std::size_t wanted = command.action == "diff" ? 2 : 1;
  const auto refuse = [&](const std::string& what) {
    throw Failure(usage,
                  fmt::format("sensor {}: {}: see proofmass sensor --help", command.action, what));
  };
  if (command.files.size() != wanted)
    refuse(wanted == 2 ? "expected two sensor files, OLD and NEW" : "expected one sensor file");
  if (exports && command.format.empty()) refuse("expected --format imu-yaml or c-header");
  if (exports && (!command.output.report.empty() || !command.output.page.empty()))
    refuse("an export has no --report and no --page");
  if (exports) return;
  if (!command.format.empty()) refuse("--format is for export");
  if (command.rate_hz || !command.rostopic.empty()) refuse("--rate and --rostopic are for export");
  if (!command.output.output.empty())
    refuse("--output is for export; --json and --report write the results");
}

// A sensor file that lacks data for the export is a faulty input.
std::string exported(const SensorCommand& command, const sensor::SensorModel& model) {
  sensor::ImuYamlOptions options{.rate_hz = command.rate_hz};
  if (!command.rostopic.empty()) options.rostopic = command.rostopic;
  const Result<std::string> text =
      command.format == "c-header" ? sensor::c_header(model) : sensor::imu_yaml(model, options);
  if (!text) throw Failure(bad_input, text.error().at(command.files.front()));
  return *text;
}

// Notes of the file, and on flags that the format cannot represent.
std::vector<Note> notes_of(const SensorCommand& command, const sensor::SensorFile& file) {
  std::vector<Note> notes = file.notes;
  if (command.format == "c-header" && (command.rate_hz || !command.rostopic.empty()))
    notes.push_back({Severity::warning, "a C header does not use --rate and --rostopic"});
  return notes;
}

void run_export(const SensorCommand& command) {
  const sensor::SensorFile file =
      need(sensor::read_sensor_file(command.files.front()), Stage::reading);
  OutputFlags flags = command.output;
  // Without --output the text goes to standard output, unless the document goes there.
  if (flags.output.empty() && flags.json != "-") flags.output = "-";
  report::SensorExport result{.file = command.files.front(),
                              .format = command.format,
                              .output = {},
                              .text = exported(command, file.model),
                              .notes = notes_of(command, file)};
  if (!flags.output.empty()) result.output = flags.output;
  if (flags.output == "-")
    print_out(result.text);
  else if (result.output)
    write_text(flags.output, result.text, flags);
  finish(report::describe(result), {}, flags);
}

void run_show(const SensorCommand& command) {
  sensor::SensorFile file = need(sensor::read_sensor_file(command.files.front()), Stage::reading);
  const report::SensorShow shown{command.files.front(), std::move(file.model),
                                 std::move(file.notes)};
  finish(report::describe(shown), {}, command.output);
}

void run_diff(const SensorCommand& command) {
  const sensor::SensorFile before =
      need(sensor::read_sensor_file(command.files[0]), Stage::reading);
  const sensor::SensorFile after = need(sensor::read_sensor_file(command.files[1]), Stage::reading);
  report::SensorDiff diff{command.files[0], command.files[1], before.notes,
                          sensor::compare(before.model, after.model)};
  diff.notes.insert(diff.notes.end(), after.notes.begin(), after.notes.end());
  finish(report::describe(diff), {}, command.output);
  if (command.output.strict && diff.comparison.all == sensor::Verdict::changed)
    throw Failure(bad_data,
                  fmt::format("done, but {} has changed from {} by more than its uncertainty "
                              "(--strict)",
                              command.files[1], command.files[0]));
}

void run_sensor(const SensorCommand& command) {
  check(command);
  if (command.action == "show")
    run_show(command);
  else if (command.action == "diff")
    run_diff(command);
  else
    run_export(command);
}

}  // namespace

Verb sensor_verb() {
  return make_verb<SensorCommand>(
      {.name = "sensor", .group = "Characterise", .help = "show, compare or export sensor files"},
      add_sensor_flags, run_sensor);
}

}  // namespace proofmass::app
