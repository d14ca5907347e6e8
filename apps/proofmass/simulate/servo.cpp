#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "proofmass/report/servo_report.hpp"
#include "proofmass/servo/study.hpp"
#include "simulate/modes.hpp"

namespace proofmass::app {

void run_servo(const SimulateCommand& command) {
  const OutputFlags& flags = command.output;
  refuse_other_flags(command, {"--duration", "--gravity", "--adc-bits"});
  servo::ServoOptions options;
  options.progress = progress_bar(flags);
  if (command.seed) options.seed = *command.seed;
  if (command.rate_hz) options.rate_hz = *command.rate_hz;
  const servo::ServoStudy study = need(servo::study_servo(options), Stage::computing);
  finish(
      report::describe(report::ServoReport{.output = flags.output, .study = study}),
      [&] { return report::servo_series(study); }, flags);
}

}  // namespace proofmass::app
