#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "proofmass/report/simulate_report.hpp"
#include "proofmass/simulate/motor_rig.hpp"
#include "simulate/modes.hpp"

namespace proofmass::app {

void refuse_other_flags(const SimulateCommand& command,
                        std::initializer_list<std::string_view> also) {
  const auto given = [&](std::string_view name, const auto& value) {
    return value && std::ranges::find(also, name) != also.end();
  };
  const std::array<std::pair<bool, const char*>, 19> flags{{
      {!command.rig.empty(), "a description"},
      {command.rpm.has_value(), "--rpm"},
      {command.datasheet_errors, "--datasheet-errors"},
      {command.positions.has_value(), "--positions"},
      {command.dwell_s.has_value(), "--dwell"},
      {command.supply_v.has_value(), "--supply"},
      {command.session.has_value(), "--session"},
      {command.strokes.has_value(), "--strokes"},
      {command.repetitions.has_value(), "--repetitions"},
      {command.length_m.has_value(), "--length"},
      {command.stroke_s.has_value(), "--stroke-time"},
      {command.elevation_deg.has_value(), "--elevation"},
      {command.gravity_removed, "--gravity-removed"},
      {command.gyro, "--gyro"},
      {command.print_config, "--print-config"},
      {!command.signal.empty(), "--signal"},
      {given("--duration", command.duration_s), "--duration"},
      {given("--gravity", command.gravity_mps2), "--gravity"},
      {given("--adc-bits", command.adc_bits), "--adc-bits"},
  }};
  const auto foreign = std::ranges::find_if(flags, [](const auto& flag) { return flag.first; });
  if (foreign != flags.end())
    throw Failure(usage, fmt::format("{} is not for --procedure {}: leave it out", foreign->second,
                                     command.procedure));
}

void run_motor(const SimulateCommand& command) {
  const OutputFlags& flags = command.output;
  refuse_other_flags(command, {});
  simulate::MotorOptions options;
  if (command.seed) options.seed = *command.seed;
  if (command.rate_hz) options.rate_hz = *command.rate_hz;
  if (command.duration_s) options.duration_s = *command.duration_s;
  if (command.gravity_mps2) options.gravity_mps2 = *command.gravity_mps2;
  if (command.adc_bits) options.adc_bits = *command.adc_bits;
  if (flags.output.empty())
    throw Failure(usage, "simulate: no --output: say where to, -o drive.csv");
  const simulate::MotorResult result = need(simulate::simulate_motor(options), Stage::computing);
  report::MotorRigReport report{.output = flags.output, .options = options, .result = result};
  write_series(result.recording, flags);
  if (flags.output != "-") {
    report.truth = truth_name(flags.output);
    write_series(result.truth, with_output(flags, report.truth));
  }
  finish(report::describe(report), {}, flags);
}

}  // namespace proofmass::app
