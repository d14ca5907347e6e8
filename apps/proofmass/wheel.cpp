#include "proofmass/estimate/wheel.hpp"

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "output.hpp"
#include "proofmass/report/wheel_report.hpp"
#include "verbs.hpp"
#include "wheel_input.hpp"

namespace proofmass::app {
void run(const WheelCommand& command) {
  report::WheelReport report;
  report.inputs = command.files;
  if (!command.spin_axis.empty()) report.options.spin_axis = parse_axis(command.spin_axis);
  report.options.radius_m = command.radius_m;
  report.options.rim_radius_m = command.rim_radius_m;
  report.options.rolling_radius_m = command.rolling_radius_m;
  report.options.radius_std_m = command.radius_std_m;
  if (command.axle_tilt_std_deg)
    report.options.axle_tilt_std_rad = *command.axle_tilt_std_deg * rad_per_deg;
  report.options.gravity_mps2 = gravity_mps2(command.input);
  WheelInput input = wheel_input(command.files, command.input,
                                 {!command.no_gyro, command.rate_unit}, command.output);
  report.options.bandwidth_hz = command.bandwidth_hz ? command.bandwidth_hz : input.bandwidth_hz;
  report.notes = std::move(input.notes);
  report.options.clocks_shared = input.clocks_shared;
  report.options.alignment_std_rad = input.alignment_std_rad;
  report.options.progress = progress_bar(command.output);
  report.solution = need(estimate::estimate_wheel(input.sensors, report.options), Stage::computing);
  report.options.progress = {};  // which wipes the bar away
  finish(report::describe(report), [&] { return report::wheel_series(report); }, command.output);
}

}  // namespace proofmass::app
