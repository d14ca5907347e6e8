#include "proofmass/estimate/wheel.hpp"

#include <algorithm>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "output.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/wheel_report.hpp"
#include "verbs.hpp"
#include "wheel_input.hpp"

namespace proofmass::app {
namespace {

bool is_bad(const report::WheelReport& report) {
  const auto& sensors = report.solution.sensors;
  return !report::texts(report.notes, Severity::bad).empty() ||
         !report::texts(report.solution.notes, Severity::bad).empty() ||
         std::any_of(sensors.begin(), sensors.end(),
                     [](const auto& fit) { return fit.unusable > 0; });
}

}  // namespace

void run(const WheelCommand& command) {
  if (command.output.output == "-" && command.output.json == "-") {
    throw Failure(usage, "--output - and --json - cannot both have standard output: name a file");
  }
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
  show_notes(report.notes, "", command.output);
  show_notes(report.solution.notes, "", command.output);
  if (!command.output.output.empty())
    write_series(report::wheel_series(report), command.output.output);
  publish({.text = [&] { return report::wheel_text(report); },
           .json = [&] { return report::wheel_json(report); },
           .html = [&] { return report::wheel_html(report); }},
          command.output);
  hold_to_strict(command.output, is_bad(report));
}

}  // namespace proofmass::app
