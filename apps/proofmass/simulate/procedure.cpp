#include "proofmass/simulate/procedure.hpp"

#include <fmt/format.h>
#include <vector>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/simulate_report.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "proofmass/simulate/procedure_file.hpp"
#include "simulate/modes.hpp"

namespace proofmass::app {
namespace {

using simulate::Procedure;
using simulate::ProcedureOptions;

void refuse_flags_of_the_rig(const SimulateCommand& command) {
  const char* flag = command.rpm                ? "--rpm"
                     : command.duration_s       ? "--duration"
                     : command.datasheet_errors ? "--datasheet-errors"
                                                : nullptr;
  if (flag != nullptr)
    throw Failure(usage, fmt::format("{} is for the rig, not for --procedure: leave it out", flag));
}

void set_positions(int positions, ProcedureOptions& options) {
  if (options.procedure == Procedure::tumble) {
    options.table.positions = positions;
  } else if (options.procedure == Procedure::multi_position) {
    options.hand.poses = positions;
  } else if (options.procedure == Procedure::slide) {
    throw Failure(usage, "--positions: a slide has strokes: give --strokes");
  } else {
    throw Failure(usage, fmt::format("--positions: {} has a fixed number",
                                     simulate::name_of(options.procedure)));
  }
}

void set_signal(const std::string& signal, ProcedureOptions& options) {
  if (const auto output = simulate::output_named(signal)) options.output = *output;
  if (options.output == simulate::RigOutput::counts)
    options.daq = simulate::with_steps(options.daq, options.supply.reference_v);
}

void set_slide(const SimulateCommand& command, ProcedureOptions& options) {
  const bool asked = command.strokes || command.repetitions || command.length_m ||
                     command.stroke_s || command.elevation_deg || command.gravity_removed ||
                     command.gyro;
  if (!asked) return;
  if (options.procedure != Procedure::slide)
    throw Failure(usage,
                  "--strokes, --repetitions, --length, --stroke-time, --elevation, "
                  "--gravity-removed and --gyro are for --procedure slide");
  if (command.strokes) options.slide.strokes = *command.strokes;
  if (command.repetitions) options.slide.repetitions = *command.repetitions;
  if (command.length_m) options.slide.length_m = *command.length_m;
  if (command.stroke_s) options.timing.move_s = *command.stroke_s;
  if (command.elevation_deg) options.slide.elevation_rad = *command.elevation_deg * rad_per_deg;
  if (command.gravity_removed) options.slide.gravity_removed = true;
  if (command.gyro) options.slide.gyro = true;
}

ProcedureOptions procedure_options(const SimulateCommand& command) {
  const Procedure procedure = *simulate::procedure_named(command.procedure);
  ProcedureOptions options = simulate::default_options(procedure);
  if (!command.rig.empty()) {
    const Result<ProcedureOptions> read = simulate::read_procedure_file(command.rig, procedure);
    // Any error in the file is a faulty input.
    if (!read) throw Failure(bad_input, read.error());
    options = *read;
  }
  if (command.seed) options.seed = *command.seed;
  if (command.session) options.session = *command.session;
  if (command.rate_hz) options.rate_hz = *command.rate_hz;
  if (command.gravity_mps2) options.gravity_mps2 = *command.gravity_mps2;
  if (command.adc_bits) options.daq.bits = *command.adc_bits;
  if (command.positions) set_positions(*command.positions, options);
  if (command.dwell_s) options.timing.dwell_s = *command.dwell_s;
  if (command.supply_v) options.supply.actual_v = *command.supply_v;
  set_slide(command, options);
  set_signal(command.signal, options);
  return options;
}

// "poses.csv" → "poses.sensor.toml".
std::string sensor_name(const std::string& truth) {
  constexpr std::string_view mark = ".truth";
  return truth.substr(0, truth.rfind(mark)) + ".sensor.toml";
}

}  // namespace

void run_procedure(const SimulateCommand& command) {
  const OutputFlags& flags = command.output;
  refuse_flags_of_the_rig(command);
  const ProcedureOptions options = procedure_options(command);
  const Status fits = simulate::check(options);
  if (!fits) throw Failure(usage, fits.error());
  if (command.print_config) return print_out(simulate::format_procedure_file(options));
  if (flags.output.empty())
    throw Failure(usage, "simulate: no --output: say where to, -o poses.csv");
  const simulate::ProcedureResult result =
      need(simulate::simulate_procedure(options, progress_bar(flags)), Stage::computing);
  report::ProcedureReport report{.output = flags.output, .options = options, .result = result};
  if (!command.rig.empty()) report.inputs = {command.rig};
  write_series(result.recording, flags);
  if (flags.output != "-") {
    report.truth = truth_name(flags.output);
    report.sensor = sensor_name(report.truth);
    write_series(result.truth_series, with_output(flags, report.truth));
    write_text(report.sensor, sensor::format_sensor_file(result.truth.sensor), flags);
  }
  finish(report::describe(report), {}, flags);
}

}  // namespace proofmass::app
