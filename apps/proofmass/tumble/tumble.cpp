#include "proofmass/calibrate/tumble.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "proofmass/calibrate/tumble/axes.hpp"
#include "proofmass/report/tumble/report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/calibration_update.hpp"
#include "tumble/command.hpp"
#include "tumble/modes.hpp"
#include "tumble/positions.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

// Flags of `tumble` for the positions.
void add_position_flags(CLI::App& verb, TumbleCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--angles", command.angles_deg, "DEG,…",
      "angle of each rest of a recording, in order: \"0,90,180,270,0\"")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(finite());
  add("--rests", command.rests, "FILE",
      "start and end of each rest, optionally with the table's angle (default: detected)");
  add("--angle", command.angle_channel, "NAME",
      "the column with the angle (default: found by name and unit)");
  add("--rest", command.shortest_rest_s, "S", "minimum duration of a rest (default: found)")
      ->check(positive());
  add("--plane", command.planes, "1|2", "plane of the tumble; once for all files or once for each")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({1, 2}));
  add("--mount", command.mounts, "0|180",
      "mounting of the sensor on the table; once for all files or once for each")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({0, 180}));
  add("--input-axis", command.input_axis, "NAME",
      "the channel whose axis measures g·sin(angle) (default: found from the data)");
  add("--indexing-std", command.indexing_std_deg, "DEG",
      "standard deviation of the table's angles (default: 0.5, less if the residuals show it)")
      ->check(not_negative());
  add("--drift-std", command.drift_std_mps2, "M_PER_S2",
      "standard deviation of the bias drift about a straight line (default: 0.0057, 1 mg/√3, and a "
      "quarter of the linear drift; less if repeats show it)")
      ->check(not_negative());
  add("--bandwidth", command.bandwidth_hz, "HZ",
      "bandwidth of the sensor's one-pole filter, with --rotating --angle: its delay is removed "
      "from the misalignment")
      ->check(positive());
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
}

void add_tumble_flags(CLI::App& verb, TumbleCommand& command) {
  verb.add_option("FILE", command.files,
                  "positions (angle and output), or a recording with a rest in each; - is standard "
                  "input (CSV)")
      ->type_name("")
      ->required();
  add_position_flags(verb, command);
  verb.add_flag("--rotating", command.rotating,
                "the sensor rotated continuously: scale factor and bias from the turns");
  verb.add_option("--coefficients", command.coefficients,
                  "fit these coefficients of the whole model equation")
      ->type_name("K0,K1...")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--update-sensor", command.update_sensor,
                  "write bias and scale into this sensor file")
      ->type_name("FILE.toml");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the positions with fit and residuals");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass tumble positions.csv --unit g --report tumble.html");
}

using calibrate::TumbleQuantity;
using report::ChannelTumble;

std::optional<std::size_t> input_axis(const TumbleCommand& command,
                                      const TumbleReadings& readings) {
  if (command.input_axis.empty()) return std::nullopt;
  for (std::size_t k = 0; k < readings.outputs.size(); ++k)
    if (readings.outputs[k].name == command.input_axis) return k;
  throw Failure(usage, "--input-axis: no channel '" + command.input_axis + "' among the outputs");
}

// The positions in whose plane the axis moves, with its outputs.
std::vector<calibrate::TumblePosition> positions_of(const TumbleReadings& readings,
                                                    const TumbleOutput& output,
                                                    const calibrate::TumbleAxis& axis) {
  std::vector<calibrate::TumblePosition> out;
  for (std::size_t k = 0; k < readings.positions.size(); ++k) {
    calibrate::TumblePosition p = readings.positions[k];
    if (!axis.phase_rad[p.plane == 2 ? 1 : 0]) continue;
    p.output = output.values[k];
    p.output_std = output.std[k];
    out.push_back(std::move(p));
  }
  return out;
}

ChannelTumble analysed(const TumbleReadings& readings,
                       const TumbleOutput& output,
                       const calibrate::TumbleAxis& axis,
                       calibrate::TumbleOptions options) {
  ChannelTumble channel{.name = output.name,
                        .unit = output.unit,
                        .axis = axis,
                        .positions = {},
                        .fit = {},
                        .refused = {}};
  if (!axis.follows_angle()) {
    channel.refused = "the output " + axis.words + ", and a tumble about it does not excite it";
    return channel;
  }
  channel.positions = positions_of(readings, output, axis);
  options.noise_dof = output.noise_dof;
  options.output_unit = output.unit.symbol;
  for (std::size_t p = 0; p < 2; ++p) options.phase_rad[p] = axis.phase_rad[p].value_or(0.0);
  Result<calibrate::TumbleFit> fit = calibrate::fit_tumble(channel.positions, options);
  if (fit)
    channel.fit = std::move(fit).value();
  else
    channel.refused = fit.error().message;
  return channel;
}

// The input axis: as given, else the first that follows sin(angle), else the first with a fit.
std::size_t main_channel(const report::TumbleReport& report, std::optional<std::size_t> input) {
  if (input) return *input;
  const auto follows_sine = [](const ChannelTumble& c) {
    return c.fit && c.axis.phase_rad[0] && *c.axis.phase_rad[0] == 0.0;
  };
  const auto& channels = report.channels;
  auto found = std::find_if(channels.begin(), channels.end(), follows_sine);
  if (found == channels.end())
    found = std::find_if(channels.begin(), channels.end(),
                         [](const ChannelTumble& c) { return c.fit.has_value(); });
  return found == channels.end() ? 0 : static_cast<std::size_t>(found - channels.begin());
}

sensor::MeasuredCalibration measured(const report::TumbleReport& report,
                                     const TumbleReadings& readings,
                                     std::vector<Note>& notes) {
  sensor::MeasuredCalibration out;
  for (std::size_t k = 0; k < report.channels.size(); ++k) {
    const ChannelTumble& channel = report.channels[k];
    const auto axis = readings.outputs[k].axis;
    const calibrate::TumbleCoefficient* scale =
        channel.fit ? channel.fit->find(TumbleQuantity::K1) : nullptr;
    if (!axis || scale == nullptr || !scale->std || !channel.fit->bias_output_std) {
      const char* why = !axis              ? "it is not an x, y or z axis of one accelerometer"
                        : scale == nullptr ? "it was refused"
                                           : "its figures have no standard deviation";
      notes.push_back({Severity::warning,
                       fmt::format("{}: not written into the sensor file: {}", channel.name, why)});
      continue;
    }
    out.bias[*axis] = Uncertain{*channel.fit->bias_output, *channel.fit->bias_output_std};
    // The axes of a sensor file are the sensor's own.
    const double own = channel.fit->own_axis_ratio();
    out.scale[*axis] = Uncertain{own * *scale->value, own * *scale->std};
    out.bias_unit = channel.unit.symbol;
    out.scale_unit = scale->unit;
  }
  out.gravity_mps2 = Uncertain{report.gravity_mps2, report.gravity_std_mps2};
  out.origin = fmt::format("proofmass tumble {}, {}", report::file_name(report.inputs.front()),
                           report::count_words(readings.positions.size(), "position"));
  return out;
}

// Notes the flags that would replace an assumption.
void note_assumptions(report::TumbleReport& report) {
  const auto any = [&](const auto& assumed) {
    return std::any_of(report.channels.begin(), report.channels.end(),
                       [&](const ChannelTumble& c) { return c.fit && assumed(*c.fit); });
  };
  if (any([](const calibrate::TumbleFit& fit) { return fit.indexing.assumed; }))
    report.notes.push_back(
        {Severity::info, "--indexing-std states the accuracy of the table's angles; 0 is exact"});
  if (any([](const calibrate::TumbleFit& fit) { return fit.drift.nonlinear_assumed; }))
    report.notes.push_back({Severity::info,
                            "--drift-std states the bias drift; a second turn, a turn "
                            "backwards or a temperature column would determine it"});
}

void update_sensor(const TumbleCommand& command,
                   const TumbleReadings& readings,
                   report::TumbleReport& report) {
  const sensor::MeasuredCalibration found = measured(report, readings, report.notes);
  if (std::none_of(found.scale.begin(), found.scale.end(), [](const auto& s) { return s; })) return;
  Result<std::vector<Note>> changes = sensor::update_calibration(command.update_sensor, found);
  if (!changes) throw Failure(status_of(changes.error(), Stage::writing), changes.error());
  for (Note& note : std::move(changes).value()) report.notes.push_back(std::move(note));
}

void check(const TumbleCommand& command) {
  if (!command.angles_deg.empty() && !command.angle_channel.empty())
    throw Failure(usage, "--angles and --angle: give one of them");
  if (command.bandwidth_hz)
    throw Failure(usage, "--bandwidth: a table at rest shows no delay; use it with --rotating");
  if (!command.rests.empty() && command.files.size() > 1)
    throw Failure(usage, "--rests: one list goes with one file");
  if (!command.update_sensor.empty() && !command.input.sensors.empty())
    throw Failure(usage,
                  "--update-sensor with --sensor: the data are already calibrated; omit "
                  "--sensor to recalibrate");
}

}  // namespace

void run_tumble(const TumbleCommand& command) {
  if (command.rotating) return run_rotation(command);
  if (!command.coefficients.empty()) return run_model_equation(command);
  check(command);
  report::TumbleReport report;
  report.inputs = command.files;
  const Uncertain gravity =
      uncertain_gravity_mps2(command.input, command.gravity_std_mps2, report.notes);
  report.gravity_mps2 = gravity.value;
  report.gravity_std_mps2 = gravity.std;
  if (command.indexing_std_deg) report.indexing_std_rad = *command.indexing_std_deg * rad_per_deg;
  const TumbleReadings readings = tumble_readings(command, report.notes);
  report.source = readings.source;
  std::vector<std::vector<double>> outputs;
  outputs.reserve(readings.outputs.size());
  for (const TumbleOutput& output : readings.outputs) outputs.push_back(output.values);
  const auto input = input_axis(command, readings);
  const std::vector<calibrate::TumbleAxis> axes =
      calibrate::tumble_axes(readings.positions, outputs, input);
  const calibrate::TumbleOptions options{.gravity_mps2 = report.gravity_mps2,
                                         .gravity_std_mps2 = report.gravity_std_mps2,
                                         .indexing_std_rad = report.indexing_std_rad,
                                         .drift_std_mps2 = command.drift_std_mps2};
  for (std::size_t k = 0; k < axes.size(); ++k)
    report.channels.push_back(analysed(readings, readings.outputs[k], axes[k], options));
  report.main = main_channel(report, input);
  note_assumptions(report);
  if (!command.update_sensor.empty())
    without_interruption([&] { update_sensor(command, readings, report); });
  finish(report::describe(report), [&] { return report::tumble_series(report); }, command.output);
}

Verb tumble_verb() {
  return make_verb<TumbleCommand>({.name = "tumble",
                                   .group = "Characterise",
                                   .help = "scale factor, bias and further model coefficients from "
                                           "a dividing head or rate table, IEEE 1293"},
                                  add_tumble_flags, run_tumble);
}

}  // namespace proofmass::app
