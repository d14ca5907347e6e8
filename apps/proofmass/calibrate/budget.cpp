#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/budget_report.hpp"
#include "proofmass/sensor/grades.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct BudgetCommand {
  std::vector<double> bias_mg, times_s;
  std::vector<std::string> sensors, parts;
  double temperature_change_k = 5.0;
  OutputFlags output;
};

void add_budget_flags(CLI::App& verb, BudgetCommand& command) {
  CLI::Option* bias =
      verb.add_option("--bias-mg", command.bias_mg, "residual bias; may be repeated");
  bias->type_name("MG")->delimiter(',')->allow_extra_args(false)->check(finite());
  verb.add_option("--sensor", command.sensors,
                  "take bias and noise (white, flicker, random walk, ramp) from this sensor file")
      ->type_name("FILE.toml")
      ->allow_extra_args(false);
  verb.add_option("--times", command.times_s, "elapsed times (default 1,10,60,3600)")
      ->type_name("S,S...")
      ->delimiter(',')
      ->check(not_negative());
  verb.add_option("--parts", command.parts,
                  "compare accelerometers by their datasheets: names, or all; with and without "
                  "rests")
      ->type_name("NAME,...|all")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--temperature-change", command.temperature_change_k,
                  "of the calibrated --parts since their calibration (default 5)")
      ->type_name("K")
      ->check(not_negative());
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass budget --bias-mg 3 --times 1,10,60");
}

double si_or_zero(const std::optional<sensor::Figure>& figure) {
  return figure ? figure->si() : 0.0;
}

// A calibrated axis: the bias is corrected, and the residual bias is its standard deviation.
estimate::BudgetSensor axis_of(const sensor::SensorModel& model, std::size_t axis) {
  const sensor::Figure& bias = *model.calibration.bias[axis];
  const auto& scale = model.calibration.scale[axis];
  // A bias in volts or counts is converted to an acceleration by the scale.
  const bool electric = bias.unit.si_symbol != "m/s^2";
  const double per_mps2 = electric && scale ? scale->si() : 1.0;
  const sensor::NoiseModel& noise = model.noise;
  return {fmt::format("{} {}", model.name, "xyz"[axis]),
          {0.0, *bias.std_si() / per_mps2},
          {.white_mps2_rthz = si_or_zero(noise.white[axis]),
           .flicker_mps2 = si_or_zero(noise.flicker[axis]),
           .random_walk_mps2_rts = si_or_zero(noise.random_walk[axis]),
           .ramp_mps3 = si_or_zero(noise.ramp[axis])}};
}

// Noise terms with the fastest growth of the error that are missing from the file or only bounded
// by it, and therefore not included in the error.
std::string unknown_noise(const sensor::SensorModel& model, std::size_t axis) {
  const sensor::NoiseModel& noise = model.noise;
  std::vector<std::string> names;
  const auto look = [&](const char* name, const std::optional<sensor::Figure>& figure) {
    if (!figure) names.emplace_back(name);
    if (!figure || figure->value != 0.0 || !figure->std) return;
    constexpr double one_sided_95 = 1.645;  // as `noise --update-sensor` writes an upper bound
    names.push_back(fmt::format("{} (below {:.2g} {})", name, one_sided_95 * *figure->std,
                                figure->unit.symbol));
  };
  look("white noise", noise.white[axis]);
  look("flicker", noise.flicker[axis]);
  look("random walk", noise.random_walk[axis]);
  return fmt::format("{}", fmt::join(names, ", "));
}

void note_unknown(const sensor::SensorModel& model, std::vector<Note>& notes) {
  std::array<std::string, 3> unknown;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& bias = model.calibration.bias[axis];
    if (bias && bias->std) unknown[axis] = unknown_noise(model, axis);
  }
  const auto note = [&](const std::string& of, const std::string& names) {
    if (names.empty()) return;
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: the sensor file does not determine {}: the error has no share "
                     "of it and may be larger",
                     of, names)});
  };
  if (unknown[0] == unknown[1] && unknown[1] == unknown[2]) {
    note(model.name, unknown[0]);
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    note(fmt::format("{} {}", model.name, "xyz"[axis]), unknown[axis]);
}

std::vector<estimate::BudgetSensor> axes_of(const std::string& path, std::vector<Note>& notes) {
  const sensor::SensorFile file = need(sensor::read_sensor_file(path), Stage::reading);
  notes.insert(notes.end(), file.notes.begin(), file.notes.end());
  std::vector<estimate::BudgetSensor> sensors;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& bias = file.model.calibration.bias[axis];
    if (bias && bias->std) sensors.push_back(axis_of(file.model, axis));
  }
  note_unknown(file.model, notes);
  if (sensors.empty()) {
    throw Failure(bad_input,
                  path +
                      ": calibration.bias: expected a figure with its std, from which the "
                      "bias that is left follows: calibrate the sensor first, or give "
                      "--bias-mg");
  }
  return sensors;
}

std::vector<const sensor::AccelerometerPart*> parts_of(const std::vector<std::string>& names) {
  std::vector<const sensor::AccelerometerPart*> parts;
  for (const std::string& name : names) {
    if (name == "all") {
      for (const sensor::AccelerometerPart& part : sensor::accelerometer_parts())
        parts.push_back(&part);
      continue;
    }
    if (const sensor::AccelerometerPart* part = sensor::find_part(name)) {
      parts.push_back(part);
      continue;
    }
    std::string known;
    for (const sensor::AccelerometerPart& part : sensor::accelerometer_parts())
      known += fmt::format("{}{}", known.empty() ? "" : ", ", part.name);
    throw Failure(usage, fmt::format("--parts: no part {}: expected all, or of {}", name, known));
  }
  return parts;
}

void run_budget(const BudgetCommand& command) {
  report::BudgetReport report;
  std::vector<estimate::BudgetSensor> sensors;
  for (const double mg : command.bias_mg) {
    sensors.push_back({fmt::format("{:.6g} mg", mg), {mg * 1e-3 * standard_gravity_mps2, 0.0}, {}});
  }
  for (const std::string& path : command.sensors) {
    for (auto& axis : axes_of(path, report.notes)) sensors.push_back(std::move(axis));
  }
  const auto parts = parts_of(command.parts);
  if (sensors.empty() && parts.empty()) sensors = estimate::grade_sensors();
  std::vector<double> times_s = command.times_s;
  if (times_s.empty() && !parts.empty() && sensors.empty()) times_s = {10.0};
  if (times_s.empty()) times_s.assign(sensor::grade_times_s.begin(), sensor::grade_times_s.end());
  std::sort(times_s.begin(), times_s.end());
  report.inputs = command.sensors;
  report.temperature_change_k = command.temperature_change_k;
  report.parts = report::part_rows(parts, times_s, command.temperature_change_k);
  report.rows = estimate::position_budget(sensors, times_s);
  finish(report::describe(report), {}, command.output);
}

}  // namespace

Verb budget_verb() {
  return make_verb<BudgetCommand>(
      {.name = "budget", .group = "Estimate", .help = "position error against time for a sensor"},
      add_budget_flags, run_budget);
}

}  // namespace proofmass::app
