#include <fmt/format.h>

#include "console.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/simulate_report.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig_file.hpp"
#include "simulate_modes.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

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
    // Whatever is wrong in the file is wrong with the input.
    if (!read) throw Failure(bad_input, read.error().message);
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

void run(const SimulateCommand& command) {
  if (!command.procedure.empty()) return run_procedure(command);
  const OutputFlags& flags = command.output;
  const simulate::RigOptions options = rig_options(command);
  if (command.print_config) {
    const Status fits = simulate::check(options);
    if (!fits) throw Failure(usage, fits.error().message);
    print_out(simulate::format_rig_file(options));
    return;
  }
  if (flags.output.empty()) throw Failure(usage, "simulate: no --output: say where to, -o rig.csv");
  const simulate::RigResult result =
      need(simulate::simulate_rig(options, progress_bar(flags)), Stage::computing);
  show_notes(result.recording.notes, "", flags);
  const std::string truth = flags.output == "-" ? "" : truth_name(flags.output);
  write_series(result.recording, flags.output);
  if (!truth.empty()) write_series(result.truth, truth);
  const std::vector<std::string> inputs =
      command.rig.empty() ? std::vector<std::string>{} : std::vector{command.rig};
  const report::SimulateReport report{inputs, flags.output, truth, options, result};
  publish({.text = [&] { return report::simulate_text(report); },
           .json = [&] { return report::simulate_json(report); },
           .html = {}},
          flags);
}

}  // namespace proofmass::app
