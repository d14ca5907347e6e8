#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/simulate_report.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig_file.hpp"
#include "simulate/command.hpp"
#include "simulate/modes.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

void add_procedure_flags(CLI::App& verb, SimulateCommand& command) {
  CLI::Option* procedure = verb.add_option(
      "--procedure", command.procedure,
      "instead of the rig: tumble, four-position, six-position, multi-position, "
      "slide (motion along a line), motor (the rig's drive), or servo (the drive in "
      "closed loops)");
  procedure->type_name("NAME")->check(CLI::IsMember(
      {"tumble", "four-position", "six-position", "multi-position", "slide", "motor", "servo"}));
  const auto add = [&](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->needs(procedure)->group("Procedure");
  };
  add("--session", command.session, "N", "another session with the same sensor and table")
      ->check(not_negative());
  add("--positions", command.positions, "N",
      "number of positions of tumble or multi-position (default 24)");
  add("--dwell", command.dwell_s, "S", "duration of each position")->check(positive());
  add("--supply", command.supply_v, "V", "supply of the ratiometric sensor (default 3.3)")
      ->check(positive());
  add("--strokes", command.strokes, "N",
      "slide: number of strokes, each followed by a rest (default 6)");
  add("--repetitions", command.repetitions, "N", "slide: repetitions of each stroke");
  add("--length", command.length_m, "M", "slide: length of a stroke (default 0.4)")
      ->check(finite());
  add("--stroke-time", command.stroke_s, "S", "slide: duration of a stroke (default 1)")
      ->check(positive());
  add("--elevation", command.elevation_deg, "DEG",
      "slide: elevation of the line above the horizontal")
      ->check(finite());
  verb.add_flag("--gravity-removed", command.gravity_removed, "slide: remove gravity, as phones do")
      ->needs(procedure)
      ->group("Procedure");
  verb.add_flag("--gyro", command.gyro, "slide: add angular-rate channels")
      ->needs(procedure)
      ->group("Procedure");
  add("--signal", command.signal, "KIND", "acceleration (default), voltage or counts")
      ->check(CLI::IsMember({"acceleration", "voltage", "counts"}));
}

void add_simulate_flags(CLI::App& verb, SimulateCommand& command) {
  verb.add_option("RIG", command.rig, "description, TOML (default: the thesis's rig)")
      ->type_name("");
  verb.add_option("--seed", command.seed, "seed of the random numbers")
      ->type_name("N")
      ->check(not_negative());
  verb.add_option("--rpm", command.rpm, "constant speed")->type_name("RPM")->check(finite());
  verb.add_option("--rate", command.rate_hz, "sample rate")->type_name("HZ")->check(positive());
  verb.add_option("--duration", command.duration_s, "length of the recording")
      ->type_name("S")
      ->check(positive());
  verb.add_option("--gravity", command.gravity_mps2, "local gravity (default 9.80665)")
      ->type_name("M_PER_S2")
      ->check(positive());
  verb.add_flag("--datasheet-errors", command.datasheet_errors,
                "misalignment, cross-axis, scale-factor and nonlinearity errors within the "
                "datasheet's limits");
  verb.add_option("--adc-bits", command.adc_bits, "resolution of the converter")->type_name("N");
  verb.add_flag("--print-config", command.print_config, "print the description and stop");
  add_procedure_flags(verb, command);
  add_output_file(verb, command.output,
                  "the recording; the truth goes to FILE.truth.csv; - is standard output");
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n  proofmass simulate --rpm 15 --seed 7 -o rig.csv\n"
      "  proofmass simulate --procedure multi-position -o poses.csv\n"
      "  proofmass simulate --procedure slide --length 0.5 -o slide.csv\n"
      "  proofmass simulate --procedure motor -o drive.csv\n"
      "  proofmass simulate --procedure servo");
}

void set_speed(const SimulateCommand& command, std::vector<simulate::SpeedSegment>& profile) {
  if (command.rpm) {
    double duration_s = 0.0;
    for (const simulate::SpeedSegment& segment : profile) duration_s += segment.duration_s;
    profile = {{.duration_s = duration_s, .speed_radps = *command.rpm * radps_per_rpm}};
  }
  if (!command.duration_s) return;
  if (profile.size() != 1) {
    throw Failure(usage,
                  fmt::format("--duration: {} has {} segments: change their durations there, or "
                              "give --rpm",
                              command.rig, profile.size()));
  }
  profile.front().duration_s = *command.duration_s;
}

simulate::RigOptions rig_options(const SimulateCommand& command) {
  simulate::RigOptions options;
  if (!command.rig.empty()) {
    const Result<simulate::RigOptions> read = simulate::read_rig_file(command.rig);
    // Any error in the file is a faulty input.
    if (!read) throw Failure(bad_input, read.error());
    options = *read;
  }
  set_speed(command, options.wheel.profile);
  if (command.seed) options.seed = *command.seed;
  if (command.rate_hz) options.rate_hz = *command.rate_hz;
  if (command.gravity_mps2) options.gravity_mps2 = *command.gravity_mps2;
  if (command.datasheet_errors) options.datasheet_errors = true;
  if (command.adc_bits) options.daq.bits = *command.adc_bits;
  return options;
}

}  // namespace

// "rig.csv" → "rig.truth.csv", "rig.csv.gz" → "rig.truth.csv.gz".
std::string truth_name(const std::string& file) {
  const std::size_t folder = file.find_last_of('/');
  const std::size_t name = folder == std::string::npos ? 0 : folder + 1;
  std::size_t dot = file.ends_with(".gz") ? file.rfind('.', file.size() - 4) : file.rfind('.');
  if (dot == std::string::npos || dot < name) dot = file.size();
  return file.substr(0, dot) + ".truth" + file.substr(dot);
}

void run_simulate(const SimulateCommand& command) {
  if (command.procedure == "motor") return run_motor(command);
  if (command.procedure == "servo") return run_servo(command);
  if (!command.procedure.empty()) return run_procedure(command);
  const OutputFlags& flags = command.output;
  const simulate::RigOptions options = rig_options(command);
  if (command.print_config) {
    const Status fits = simulate::check(options);
    if (!fits) throw Failure(usage, fits.error());
    print_out(simulate::format_rig_file(options));
    return;
  }
  if (flags.output.empty()) throw Failure(usage, "simulate: no --output: say where to, -o rig.csv");
  const simulate::RigResult result =
      need(simulate::simulate_rig(options, progress_bar(flags)), Stage::computing);
  const std::string truth = flags.output == "-" ? "" : truth_name(flags.output);
  write_series(result.recording, flags);
  if (!truth.empty()) write_series(result.truth, with_output(flags, truth));
  const std::vector<std::string> inputs =
      command.rig.empty() ? std::vector<std::string>{} : std::vector{command.rig};
  const report::SimulateReport report{inputs, flags.output, truth, options, result};
  finish(report::describe(report), {}, flags);
}

Verb simulate_verb() {
  return make_verb<SimulateCommand>(
      {.name = "simulate",
       .group = "Study",
       .help = "digital twin of the rig, of a calibration procedure, of a slide or of the drive"},
      add_simulate_flags, run_simulate);
}

}  // namespace proofmass::app
