#include "proofmass/estimate/wheel.hpp"

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/encoder.hpp"
#include "input/input.hpp"
#include "input/wheel_input.hpp"
#include "proofmass/report/wheel/report.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct WheelCommand {
  std::vector<std::string> files;
  std::string spin_axis;
  std::optional<double> radius_m, radius_std_m, rim_radius_m, rolling_radius_m, bandwidth_hz,
      axle_tilt_std_deg;
  bool no_gyro = false;
  std::string rate_unit = "rad/s";
  EncoderFlags encoder;
  InputFlags input;
  OutputFlags output;
};

void add_wheel_flags(CLI::App& verb, WheelCommand& command) {
  verb.add_option("FILE", command.files, "one recording, or one for each of two sensors")
      ->type_name("")
      ->expected(1, 2)
      ->required();
  verb.add_option("--spin-axis", command.spin_axis,
                  "x, y, z, -x, -y, -z or \"X,Y,Z\" in the sensor's axes (default: found)")
      ->type_name("AXIS");
  CLI::Option* radius = verb.add_option("--radius", command.radius_m,
                                        "distance of the sensor from the axle, if known")
                            ->type_name("M")
                            ->check(not_negative());
  verb.add_option("--radius-std", command.radius_std_m,
                  "standard deviation of --radius (default: 2 %, at least 0.0002)")
      ->type_name("M")
      ->check(not_negative())
      ->needs(radius);
  verb.add_option("--bandwidth", command.bandwidth_hz,
                  "-3 dB bandwidth of the sensor's filter, which delays the angle (default: from "
                  "the --sensor file, else assumed between 6 Hz and 2.5 times the rate)")
      ->type_name("HZ")
      ->check(positive());
  verb.add_option("--axle-tilt-std", command.axle_tilt_std_deg,
                  "standard deviation of the axle's inclination (default 5)")
      ->type_name("DEG")
      ->check(not_negative());
  verb.add_flag("--no-gyro", command.no_gyro, "do not use the gyroscope's channels");
  verb.add_option("--rate-unit", command.rate_unit,
                  "unit of the gyroscope if its heading has none: rad/s (default) or deg/s")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
  verb.add_option("--rolling-radius", command.rolling_radius_m,
                  "rolling radius of a vehicle's wheel (0: a bench); corrects the angle for the "
                  "vehicle's acceleration")
      ->type_name("M")
      ->check(not_negative());
  verb.add_option("--rim-radius", command.rim_radius_m,
                  "radius of the rim, whose path length is the distance")
      ->type_name("M")
      ->check(positive());
  add_encoder_flags(verb, command.encoder,
                    "use the encoder on the axle, recorded in the first FILE, as a further "
                    "measurement");
  add_input_flags(verb, command.input);
  add_switch_on_flag(
      verb, command.input,
      "time since power-on at the first sample; removes the warm-up drift in the sensor files");
  add_output_file(verb, command.output, "write the time series with standard deviations");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass wheel hub.csv rim.csv --spin-axis z --report wheel.html");
}

void run_wheel(const WheelCommand& command) {
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
  WheelInput input =
      wheel_input(command.files, command.input, {!command.no_gyro, command.rate_unit},
                  command.encoder, command.output);
  report.options.bandwidth_hz = command.bandwidth_hz ? command.bandwidth_hz : input.bandwidth_hz;
  report.notes = std::move(input.notes);
  report.options.clocks_shared = input.clocks_shared;
  report.options.encoder = std::move(input.encoder);
  report.options.alignment_std_rad = input.alignment_std_rad;
  report.options.progress = progress_bar(command.output);
  report.solution =
      need(estimate::estimate_wheel(std::move(input.sensors), report.options), Stage::computing);
  report.options.progress = {};  // which clears the progress bar
  finish(report::describe(report), [&] { return report::wheel_series(report); }, command.output);
}

}  // namespace

Verb wheel_verb() {
  return make_verb<WheelCommand>(
      {.name = "wheel",
       .group = "Estimate",
       .help = "angle, turns and speed from one or two accelerometers on a wheel"},
      add_wheel_flags, run_wheel);
}

}  // namespace proofmass::app
