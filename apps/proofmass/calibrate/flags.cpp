#include "calibrate/flags.hpp"

#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "cli/flags.hpp"

namespace proofmass::app {
namespace {

// Flags of `calibrate` for the poses.
void add_pose_flags(CLI::App& verb, CalibrateCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--rests", command.rests, "FILE",
      "start and end of each rest, optionally with label and direction (default: detected)");
  add("--rest", command.shortest_rest_s, "S", "minimum duration of a rest (default 0.5)")
      ->check(positive());
  verb.add_flag("--means", command.means, "the files are tables of means, one row per position");
  add("--parameters", command.parameters, "6|9|12",
      "6: bias and scale factor; 9: also misalignment; 12: also mounting, from given directions "
      "(default: 9, or 6 where the positions determine no more)")
      ->check(CLI::IsMember({6, 9, 12}));
  verb.add_flag(
      "--six-position", command.six_position,
      "assume six exact orientations (the classical method; free orientations are more accurate)");
  verb.add_flag("--keep-suspects", command.keep_suspects,
                "keep positions that contradict the others in the fit");
  add("--validate", command.validate, "FILE",
      "independent positions to validate the calibration with")
      ->allow_extra_args(false);
}

// Flags of `calibrate` that concern the gyroscope.
void add_gyroscope_flags(CLI::App& verb, CalibrateCommand& command) {
  verb.add_flag("--gyro", command.gyro,
                "calibrate the gyroscope too, by the rotations between the positions");
  verb.add_option("--gyro-file", command.gyro_file,
                  "recording of the gyroscope, sampled together with FILE (implies --gyro)")
      ->type_name("FILE");
  verb.add_option("--rate-unit", command.rate_unit,
                  "unit of the gyroscope's channels if their headings have none: rad/s (default), "
                  "deg/s, or counts, whose scale is then searched for")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"rad/s", "deg/s", "counts", "V"}));
  verb.add_option("--turntable", command.turntable,
                  "a steady rotation of a turntable about any axis, in s and deg/s, optionally "
                  "with the standard deviation of the rate, or a file of such lines; may be "
                  "repeated")
      ->type_name("START,END,DEG_PER_S[,STD]|FILE")
      ->allow_extra_args(false);
}

// Flags of `calibrate --encoder`.
void add_encoder_calibration_flags(CLI::App& verb, CalibrateCommand& command) {
  add_encoder_flags(verb, command.encoder,
                    "calibrate the encoder of a wheel by the accelerometers on it, instead of an "
                    "accelerometer by positions");
  verb.add_option("--nonlinearity", command.nonlinearity_percent,
                  "standard deviation of the accelerometers' nonlinearity at 1 g, with --encoder "
                  "(default 0.02)")
      ->type_name("PERCENT")
      ->check(not_negative());
  verb.add_option("--runout", command.runout_m,
                  "standard deviation of the axle's run-out, with --encoder (default 3e-5)")
      ->type_name("M")
      ->check(not_negative());
  verb.add_option("--radius", command.radius_m,
                  "largest distance of the accelerometers from the axle, with --encoder (default "
                  "0.3)")
      ->type_name("M")
      ->check(positive());
}

// Flags of `calibrate` for uncertainties.
void add_uncertainty_flags(CLI::App& verb, CalibrateCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
  add("--orthogonality-std", command.orthogonality_std_deg, "DEG",
      "standard deviation of the angles between the axes if they are not fitted")
      ->check(not_negative())
      ->capture_default_str();
  add("--placement-std", command.placement_std_deg, "DEG",
      "standard deviation of the orientations that --six-position assumes exact")
      ->check(not_negative())
      ->capture_default_str();
  add("--bias-stability", command.bias_stability_mg, "MG",
      "standard deviation of the biases between sessions, as drift estimates it from several "
      "power-ups (default: from the flicker noise and random walk of the file to update, else of "
      "the recording)")
      ->check(not_negative());
  add("--type-b", command.type_b, "NAME,TARGET,VALUE UNIT[,DISTRIBUTION[,DOF]]",
      "a contribution to the uncertainty: \"ADC reference,scale,0.05 %,uniform\"; may be repeated")
      ->allow_extra_args(false);
  add("--monte-carlo", command.monte_carlo, "N",
      "Monte Carlo draws that check the uncertainties; 0: none (default 200; for the certificate "
      "of "
      "--report as many as JCGM 101's adaptive procedure needs, up to 1000000)");
  add("--supplies", command.supplies_v, "V,…",
      "supply voltage of each file, to estimate its effect")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positive());
}

}  // namespace

void add_calibrate_flags(CLI::App& verb, CalibrateCommand& command) {
  verb.add_option("FILE", command.files,
                  "recordings of a sensor held still in 9 or more orientations, or tables of "
                  "means; - is standard input (CSV)")
      ->type_name("")
      ->required();
  add_pose_flags(verb, command);
  add_uncertainty_flags(verb, command);
  add_gyroscope_flags(verb, command);
  add_encoder_calibration_flags(verb, command);
  verb.add_option("--name", command.name, "name of the sensor, for certificate and sensor file")
      ->type_name("TEXT");
  verb.add_option("--serial", command.serial, "its serial number")->type_name("TEXT");
  verb.add_option("--date", command.date, "of the measurement, ISO 8601")->type_name("DATE");
  verb.add_option("--temperature", command.temperature_c, "temperature of the measurement")
      ->type_name("DEG_C")
      ->check(finite());
  verb.add_option("--update-sensor", command.update_sensor,
                  "write the calibration into this sensor file")
      ->type_name("FILE.toml");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the positions with forces and residuals");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Example:\n  proofmass calibrate turned.csv --latitude 44.6 --update-sensor sensor.toml "
      "--report calibration.html");
}

void expect_sense(const CalibrateCommand& command) {
  if (command.six_position && command.parameters)
    throw Failure(usage, "--six-position implies its parameters: omit --parameters");
  if (!command.update_sensor.empty() && !command.input.sensors.empty()) {
    throw Failure(usage,
                  "--update-sensor needs uncalibrated data: omit "
                  "--sensor");
  }
  if (!command.supplies_v.empty() && command.supplies_v.size() != command.files.size()) {
    throw Failure(usage, fmt::format("--supplies: {} values for {} files: give one for each",
                                     command.supplies_v.size(), command.files.size()));
  }
  if (command.gyro && !command.supplies_v.empty())
    throw Failure(usage, "--gyro: leave out --supplies, or calibrate the gyroscope apart");
  if (!command.gyro_file.empty() && command.files.size() > 1)
    throw Failure(usage, "--gyro-file: one file goes with one recording");
  if (!command.turntable.empty() && !command.gyro)
    throw Failure(usage, "--turntable goes with --gyro");
  if (!command.rests.empty() && command.files.size() > 1)
    throw Failure(usage, "--rests: one list goes with one file");
}

}  // namespace proofmass::app
