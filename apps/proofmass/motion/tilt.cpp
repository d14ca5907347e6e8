#include "proofmass/estimate/tilt.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "proofmass/estimate/tilt/axis.hpp"
#include "proofmass/report/tilt/report.hpp"
#include "proofmass/signal/channel_audit.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

/// Accelerations; or, with `angle`, the angle computed from them and a gyroscope's rate.
struct TiltCommand {
  std::string file;
  std::string base = "auto", reads = "+g";
  std::vector<std::string> gyro;  ///< channels x, y, z; empty: detected
  bool no_gyro = false;
  std::string angle, rate_channel;  ///< columns, by name or number
  std::string angle_unit = "rad", rate_unit = "rad/s";
  std::optional<double> shortest_rest_s, bias_std_mps2, gravity_std_mps2;
  InputFlags input;
  OutputFlags output;
};

void add_tilt_flags(CLI::App& verb, TiltCommand& command) {
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--base", command.base, "KIND",
      "auto (default; still if it rests nearly throughout), still or moving")
      ->check(CLI::IsMember({"auto", "still", "moving"}));
  add("--reads", command.reads, "SIGN",
      "output at rest of an axis that points up: +g (default), or -g as on an iPhone")
      ->check(CLI::IsMember({"+g", "-g"}));
  add("--gyro", command.gyro, "NAME",
      "the gyroscope's channels for x, y and z: three of them (default: found by name and unit)")
      ->allow_extra_args(false);
  verb.add_flag("--no-gyro", command.no_gyro, "do not use the gyroscope's channels");
  add("--rate-unit", command.rate_unit, "UNIT",
      "unit of the gyroscope if its heading has none: rad/s (default) or deg/s")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
  add("--shortest-rest", command.shortest_rest_s, "S", "minimum duration of a rest (default 0.5)")
      ->check(positive());
  add("--bias-std", command.bias_std_mps2, "M_PER_S2",
      "standard deviation of the bias of each axis; with a --sensor file, of its change since the "
      "calibration (default: from a prior and the norm of the force at rest)")
      ->check(not_negative());
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
  CLI::Option* angle =
      add("--angle", command.angle, "COLUMN",
          "column with an angle instead of accelerations (name, or number from 1)");
  add("--rate-channel", command.rate_channel, "COLUMN",
      "column with the gyroscope's rate about the same axis")
      ->needs(angle);
  add("--angle-unit", command.angle_unit, "UNIT",
      "unit of that column if its heading has none: rad (default) or deg")
      ->check(CLI::IsMember({"rad", "deg"}))
      ->needs(angle);
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output,
                  "write roll and pitch against time with standard deviations");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass tilt lying.csv --sensor sensor.toml\n"
      "  proofmass tilt drive.csv --base moving --report tilt.html\n"
      "  proofmass tilt motor.dat --angle 3 --rate-channel 2");
}

std::vector<double> times_of(const Recording& recording) {
  std::vector<double> time_s(recording.samples());
  for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = recording.time.at(k);
  return time_s;
}

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
}

std::string names_of(const Recording& recording) {
  std::string names;
  for (const Channel& channel : recording.channels)
    names += (names.empty() ? "" : ", ") + channel.name;
  return names;
}

// By name, or by position in a file without names.
const Channel& column(const Recording& recording, const std::string& name, const char* flag) {
  const Channel* found = recording.find(name);
  if (found == nullptr && is_number(name)) found = recording.find("column " + name);
  if (found == nullptr)
    throw Failure(usage, fmt::format("{}: {}: no column '{}': expected one of {}", recording.source,
                                     flag, name, names_of(recording)));
  return *found;
}

// Converted to SI by the heading's unit or, if it has none, by the flag's.
std::vector<double> in_si(const Channel& channel,
                          Quantity quantity,
                          const std::string& otherwise,
                          const char* flag) {
  if (channel.unit.quantity != quantity && channel.unit.quantity != Quantity::unknown)
    throw Failure(usage, fmt::format("{}: {} is in {}: expected an {}", flag, channel.name,
                                     channel.unit.symbol, name_of(quantity)));
  const Unit unit = channel.unit.quantity == quantity ? channel.unit : *parse_unit(otherwise);
  std::vector<double> values = channel.values.copy();
  for (double& value : values) value = unit.si(value);
  return values;
}

void expect_time(const TiltCommand& command, const Recording& recording) {
  if (recording.time.source == TimeSource::none)
    throw Failure(usage,
                  command.file + ": no time column and no --rate: give --rate HZ or --time NAME");
}

estimate::AxisTiltSolution solve_axis(const TiltCommand& command, std::vector<Note>& notes) {
  if (command.rate_channel.empty())
    throw Failure(usage, "--angle: expected --rate-channel COLUMN with the gyroscope's rate too");
  const Recording recording =
      load_rising(command.file, command.input, progress_bar(command.output));
  expect_time(command, recording);
  notes.insert(notes.end(), recording.notes.begin(), recording.notes.end());
  estimate::AxisTiltRecord record{
      .time_s = times_of(recording),
      .angle_rad = in_si(column(recording, command.angle, "--angle"), Quantity::angle,
                         command.angle_unit, "--angle"),
      .rate_radps = in_si(column(recording, command.rate_channel, "--rate-channel"),
                          Quantity::angular_rate, command.rate_unit, "--rate-channel")};
  auto solution = estimate::estimate_axis_tilt(record, {.progress = progress_bar(command.output)});
  if (!solution)
    throw Failure(status_of(solution.error(), Stage::computing), solution.error().at(command.file));
  return std::move(solution).value();
}

Accelerometer only_accelerometer(const std::vector<Recording>& recordings) {
  const std::vector<Accelerometer> found = accelerometers(recordings);
  if (found.size() == 1) return found.front();
  std::string names;
  for (const Accelerometer& one : found) names += (names.empty() ? "" : ", ") + one.triad.name;
  throw Failure(usage,
                fmt::format("{}: {} accelerometers ({}), expected one: choose with --channel",
                            recordings.front().source, found.size(), names));
}

std::optional<GyroscopeChannels> gyroscope_of(const TiltCommand& command,
                                              const Recording& recording,
                                              const Triad& accelerometer) {
  if (command.no_gyro) return std::nullopt;
  if (command.gyro.empty()) return find_gyroscope(recording, accelerometer);
  if (command.gyro.size() != 3)
    throw Failure(usage, "--gyro: expected three channels, for x, y and z in this order");
  GyroscopeChannels channels{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Channel& found = column(recording, command.gyro[i], "--gyro");
    channels[i] = static_cast<std::size_t>(&found - recording.channels.data());
  }
  return channels;
}

// Quantisation is visible only before calibration mixes the axes; the extreme measurements give the
// factor to convert it.
struct RawSteps {
  double lsb = 0.0;  ///< 0: continuous, or a single value
  std::size_t lowest = 0, highest = 0;
  double range = 0.0;
};

RawSteps raw_steps(View<double> values) {
  RawSteps out{.lsb = signal::find_lsb(values).value_or(0.0)};
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!(values[k] >= values[out.lowest])) out.lowest = std::isfinite(values[k]) ? k : out.lowest;
    if (!(values[k] <= values[out.highest]))
      out.highest = std::isfinite(values[k]) ? k : out.highest;
  }
  if (!values.empty()) out.range = values[out.highest] - values[out.lowest];
  return out;
}

double step_after(const RawSteps& raw, View<double> values) {
  if (!(raw.lsb > 0.0) || !(raw.range > 0.0)) return 0.0;
  return raw.lsb * std::abs(values[raw.highest] - values[raw.lowest]) / raw.range;
}

// The accelerometer's channels, for the g-sensitivity of the gyroscope.
std::array<std::vector<double>, 3> forces_of(
    const Recording& recording, const std::array<std::optional<std::size_t>, 3>& axes) {
  std::array<std::vector<double>, 3> out;
  for (std::size_t i = 0; i < 3; ++i)
    if (axes[i]) out[i] = recording.channels[*axes[i]].values.copy();
  return out;
}

estimate::TiltRecord prepare(const TiltCommand& command,
                             estimate::TiltOptions& options,
                             std::vector<Note>& notes) {
  std::vector<Recording> recordings{
      load_rising(command.file, command.input, progress_bar(command.output))};
  Recording& recording = recordings.front();
  const auto models = load_sensors(command.input, notes);
  const Accelerometer one = only_accelerometer(recordings);
  drop_unusable(one.triad, gyroscope_of(command, recording, one.triad), recording, recording.notes);
  const std::array axes{one.triad.x, one.triad.y, one.triad.z};
  std::array<RawSteps, 3> raw;
  for (std::size_t i = 0; i < 3; ++i)
    if (axes[i]) raw[i] = raw_steps(recording.channels[*axes[i]].values);
  calibrate(models, {one}, recordings);
  remove_warm_up(command.input, models, {one}, recordings, notes);
  notes.insert(notes.end(), recording.notes.begin(), recording.notes.end());
  if (!models.empty()) {
    options.calibration = models.front().calibration;
    options.noise = models.front().noise;
  }
  estimate::TiltRecord record;
  if (recording.time.source != TimeSource::none) record.time_s = times_of(recording);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!axes[i]) continue;
    record.step_mps2[i] = step_after(raw[i], recording.channels[*axes[i]].values);
    record.accel_mps2[i] = recording.channels[*axes[i]].values.copy();
    if (command.reads == "-g")
      for (double& value : record.accel_mps2[i]) value = -value;
  }
  if (const auto channels = gyroscope_of(command, recording, one.triad))
    record.rate_radps =
        calibrated_rates_radps(recording, *channels, sensor_model_of(models, 0),
                               forces_of(recording, axes), command.rate_unit, notes);
  return record;
}

estimate::TiltBase base_of(const std::string& text) {
  if (text == "still") return estimate::TiltBase::still;
  return text == "moving" ? estimate::TiltBase::moving : estimate::TiltBase::automatic;
}

estimate::TiltSolution solve(const TiltCommand& command, report::TiltReport& report) {
  estimate::TiltOptions options{.base = base_of(command.base),
                                .bias_std_mps2 = command.bias_std_mps2,
                                .shortest_rest_s = command.shortest_rest_s,
                                .progress = progress_bar(command.output)};
  std::vector<Note> of_gravity;
  report.gravity_mps2 = options.gravity_mps2 =
      uncertain_gravity_mps2(command.input, command.gravity_std_mps2, of_gravity);
  const estimate::TiltRecord record = prepare(command, options, report.notes);
  auto solution = estimate::estimate_tilt(record, options);
  if (!solution)
    throw Failure(status_of(solution.error(), Stage::computing), solution.error().at(command.file));
  // With three axes the direction does not depend on the magnitude of gravity.
  if (solution->axes < 3)
    report.notes.insert(report.notes.end(), of_gravity.begin(), of_gravity.end());
  return std::move(solution).value();
}

void run_tilt(const TiltCommand& command) {
  report::TiltReport report;
  report.inputs = {command.file};
  report.reads_minus_g = command.reads == "-g";
  if (!command.angle.empty())
    report.axis = solve_axis(command, report.notes);
  else
    report.solution = solve(command, report);
  finish(report::describe(report), [&] { return report::tilt_series(report); }, command.output);
}

}  // namespace

Verb tilt_verb() {
  return make_verb<TiltCommand>(
      {.name = "tilt",
       .group = "Estimate",
       .help = "roll and pitch from gravity, at rest and on a moving base"},
      add_tilt_flags, run_tilt);
}

}  // namespace proofmass::app
