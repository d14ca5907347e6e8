#include "proofmass/estimate/motor.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "proofmass/report/motor/report.hpp"
#include "proofmass/signal/unusable.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct MotorCommand {
  std::string file;
  std::string voltage, current, angle;  ///< columns; empty: found by their names
  std::string angle_unit = "rad", current_unit = "A";
  bool no_current = false;
  InputFlags input;
  OutputFlags output;
};

void add_motor_flags(CLI::App& verb, MotorCommand& command) {
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--voltage", command.voltage, "COLUMN",
      "column with the motor's voltage (default: the one named voltage)");
  CLI::Option* current = add("--current", command.current, "COLUMN",
                             "column with its current (default: the one named current, if any)");
  add("--current-unit", command.current_unit, "UNIT", "unit of the current: A (default) or mA")
      ->check(CLI::IsMember({"A", "mA"}));
  verb.add_flag("--no-current", command.no_current, "do not use the current")->excludes(current);
  add("--angle", command.angle, "COLUMN",
      "column with the angle of the load, unwrapped, as an encoder's, instead of accelerometers");
  add("--angle-unit", command.angle_unit, "UNIT",
      "unit of that column if its heading has none: rad (default) or deg")
      ->check(CLI::IsMember({"rad", "deg"}));
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output,
                  "write angles of motor and load, speed, friction and contact against time");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass simulate --procedure motor -o drive.csv\n"
      "  proofmass motor drive.csv --report drive.html\n"
      "  proofmass motor bench.csv --voltage u --current i --angle encoder --angle-unit deg");
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// By its name, or the first whose name begins with the usual word.
const Channel* column_of(const Recording& recording,
                         const std::string& name,
                         const std::string& usual,
                         const char* flag) {
  if (!name.empty()) {
    const Channel* found = recording.find(name);
    if (found != nullptr) return found;
    std::string names;
    for (const Channel& channel : recording.channels)
      names += (names.empty() ? "" : ", ") + channel.name;
    throw Failure(usage, fmt::format("{}: {}: no column '{}': expected one of {}", recording.source,
                                     flag, name, names));
  }
  for (const Channel& channel : recording.channels)
    if (lower(channel.name).starts_with(usual)) return &channel;
  return nullptr;
}

std::vector<double> si_values(const Channel& channel, Quantity quantity, const Unit& otherwise) {
  const Unit& unit = channel.unit.quantity == quantity ? channel.unit : otherwise;
  std::vector<double> values = channel.values.copy();
  for (double& value : values) value = unit.si(value);
  return values;
}

// In the order of the sensors: x, y and z.
void add_accelerometers(const MotorCommand& command,
                        Recording& recording,
                        std::vector<Note>& notes,
                        estimate::MotorRecord& record) {
  std::vector<Recording> recordings{recording};
  const auto models = load_sensors(command.input, notes);
  const std::vector<Accelerometer> found = accelerometers(recordings);
  for (const Accelerometer& one : found)
    drop_unusable(one.triad, std::nullopt, recordings.front(), notes);
  calibrate(models, found, recordings);
  for (const Accelerometer& one : found) {
    auto& sensor = record.accel_mps2.emplace_back();
    const std::array axes{one.triad.x, one.triad.y, one.triad.z};
    for (std::size_t i = 0; i < 3; ++i)
      if (axes[i]) sensor[i] = recordings.front().channels[*axes[i]].values.copy();
  }
}

// Makes NaN what shows no voltage or current: a channel that was stuck, or at an end of its range.
// A controller may hold the voltage at its own limit while the current changes; only the current,
// then, has a witness.
void drop_unusable_drive(const Channel& voltage, const Channel* current, Recording& recording) {
  const auto index = [&recording](const Channel& channel) {
    return static_cast<std::size_t>(&channel - recording.channels.data());
  };
  const auto keep = [&recording](const std::vector<Note>& found) {
    recording.notes.insert(recording.notes.end(), found.begin(), found.end());
  };
  std::vector<std::vector<std::size_t>> channels{{index(voltage)}};
  if (current != nullptr) channels.push_back({index(*current)});
  keep(signal::drop_stuck(channels, recording));
  keep(signal::drop_saturated(channels.front(), recording));
  if (current != nullptr)
    keep(signal::drop_saturated(channels.back(), recording, channels.front()));
}

estimate::MotorRecord prepare(const MotorCommand& command, std::vector<Note>& notes) {
  Recording recording = load_rising(command.file, command.input, progress_bar(command.output));
  if (recording.time.source == TimeSource::none)
    throw Failure(usage,
                  command.file + ": no time column and no --rate: give --rate HZ or --time NAME");
  estimate::MotorRecord record;
  record.time_s.reserve(recording.samples());
  for (std::size_t k = 0; k < recording.samples(); ++k)
    record.time_s.push_back(recording.time.at(k));
  const Channel* voltage = column_of(recording, command.voltage, "voltage", "--voltage");
  if (voltage == nullptr)
    throw Failure(
        usage, command.file + ": no column named voltage: name the motor's with --voltage COLUMN");
  const Channel* current =
      command.no_current ? nullptr : column_of(recording, command.current, "current", "--current");
  drop_unusable_drive(*voltage, current, recording);
  notes.insert(notes.end(), recording.notes.begin(), recording.notes.end());
  record.voltage_v = si_values(*voltage, Quantity::voltage, *parse_unit("V"));
  if (current != nullptr) record.current_a = current->values.copy();
  if (command.current_unit == "mA")
    for (double& value : record.current_a) value *= 1e-3;
  if (command.angle.empty()) {
    add_accelerometers(command, recording, notes, record);
  } else {
    const Channel* angle = column_of(recording, command.angle, "", "--angle");
    record.angle_rad = si_values(*angle, Quantity::angle, *parse_unit(command.angle_unit));
  }
  return record;
}

void run_motor(const MotorCommand& command) {
  report::MotorReport report;
  report.inputs = {command.file};
  const estimate::MotorRecord record = prepare(command, report.notes);
  auto solution = estimate::estimate_motor(record, {.gravity_mps2 = gravity_mps2(command.input),
                                                    .progress = progress_bar(command.output)});
  if (!solution)
    throw Failure(status_of(solution.error(), Stage::computing), solution.error().at(command.file));
  report.solution = std::move(solution).value();
  report.notes.insert(report.notes.end(), report.solution.notes.begin(),
                      report.solution.notes.end());
  finish(report::describe(report), [&] { return report::motor_series(report); }, command.output);
}

}  // namespace

Verb motor_verb() {
  return make_verb<MotorCommand>(
      {.name = "motor",
       .group = "Estimate",
       .help = "friction, inertia and backlash of a drive, from voltage, current and wheel"},
      add_motor_flags, run_motor);
}

}  // namespace proofmass::app
