#include "flags.hpp"
#include "verb_flags.hpp"

namespace proofmass::app {
namespace {

// Flags of `calibrate` that say where the poses are.
void add_pose_flags(CLI::App& verb, CalibrateCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--rests", command.rests, "FILE",
      "start and end of each rest, perhaps with label and direction (default: found)");
  add("--rest", command.shortest_rest_s, "S", "the shortest rest to look for (default: 0.5)")
      ->check(positive());
  verb.add_flag("--means", command.means, "the files are tables of means, one row a position");
  add("--parameters", command.parameters, "6|9|12",
      "6: bias and scale; 9: and misalignment; 12: and mounting, by given directions (default: 9, "
      "or 6 where the positions carry no more)")
      ->check(CLI::IsMember({6, 9, 12}));
  verb.add_flag("--six-position", command.six_position,
                "take six given positions for exact (what others do; better: turn it freely)");
  verb.add_flag("--keep-suspects", command.keep_suspects,
                "positions that contradict the others stay in the fit");
  add("--validate", command.validate, "FILE", "new positions to try the calibration on")
      ->allow_extra_args(false);
}

// Flags of `calibrate` that say how well something is known.
void add_uncertainty_flags(CLI::App& verb, CalibrateCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
  add("--orthogonality-std", command.orthogonality_std_deg, "DEG",
      "of the angles between the axes where they are not fitted")
      ->check(not_negative())
      ->capture_default_str();
  add("--placement-std", command.placement_std_deg, "DEG",
      "of the positions that --six-position takes for exact")
      ->check(not_negative())
      ->capture_default_str();
  add("--bias-stability", command.bias_stability_mg, "MG",
      "standard deviation of the biases from one session to another, as drift finds it of several "
      "power-ups (default: by the flicker noise and random walk of the file to update, else of the "
      "recording)")
      ->check(not_negative());
  add("--type-b", command.type_b, "NAME,TARGET,VALUE UNIT[,DISTRIBUTION[,DOF]]",
      "a contribution to the uncertainty: \"ADC reference,scale,0.05 %,uniform\"; may be repeated")
      ->allow_extra_args(false);
  add("--monte-carlo", command.monte_carlo, "N", "draws that check the uncertainties; 0: none")
      ->capture_default_str();
  add("--supplies", command.supplies_v, "V,…", "supply of each file, to tell what it does")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positive());
}

// Flags of `tumble` that say how the positions stood.
void add_position_flags(CLI::App& verb, TumbleCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--angles", command.angles_deg, "DEG,…",
      "of a recording's rests, one for each in its order: \"0,90,180,270,0\"")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(finite());
  add("--rests", command.rests, "FILE",
      "start and end of each rest, perhaps with the table's angle (default: found)");
  add("--angle", command.angle_channel, "NAME",
      "the column with the angle (default: found by name and unit)");
  add("--rest", command.shortest_rest_s, "S", "the shortest rest to look for (default: found)")
      ->check(positive());
  add("--plane", command.planes, "1|2",
      "in which the file was tumbled; once for all files or once for each")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({1, 2}));
  add("--mount", command.mounts, "0|180",
      "how the sensor sat on the table; once for all files or once for each")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({0, 180}));
  add("--input-axis", command.input_axis, "NAME",
      "the channel whose axis sees g·sin(angle) (default: found from the readings)");
  add("--indexing-std", command.indexing_std_deg, "DEG",
      "standard deviation of the table's angles (default: 0.5, less where the residuals show it)")
      ->check(not_negative());
  add("--drift-std", command.drift_std_mps2, "M_PER_S2",
      "standard deviation of the amplitudes by which the bias wanders about a straight line "
      "(default: 0.0057, 1 mg/√3, and a quarter of the linear drift; less where repeats show it)")
      ->check(not_negative());
  add("--bandwidth", command.bandwidth_hz, "HZ",
      "of the sensor's filter, one pole, with --rotating --angle: its delay is taken out of the "
      "misalignment")
      ->check(positive());
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
}

}  // namespace

void add_flags(CLI::App& app, CalibrateCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "calibrate", "bias, scale and misalignment from rests in several positions");
  verb.add_option("FILE", command.files,
                  "recordings of a sensor laid down in 9 or more directions, or tables of means; - "
                  "is standard input (CSV)")
      ->type_name("")
      ->required();
  add_pose_flags(verb, command);
  add_uncertainty_flags(verb, command);
  verb.add_option("--name", command.name, "of the sensor, for certificate and sensor file")
      ->type_name("TEXT");
  verb.add_option("--serial", command.serial, "its serial number")->type_name("TEXT");
  verb.add_option("--date", command.date, "of the measurement, ISO 8601")->type_name("DATE");
  verb.add_option("--temperature", command.temperature_c, "at which it was made")
      ->type_name("DEG_C")
      ->check(finite());
  verb.add_option("--update-sensor", command.update_sensor,
                  "write the calibration into this sensor file")
      ->type_name("FILE.toml");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the positions with forces and residuals");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Example:\n  proofmass calibrate turned.csv --latitude 44.6 --update-sensor sensor.toml "
      "--report calibration.html");
}

void add_flags(CLI::App& app, TumbleCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "tumble",
      "scale factor, bias and the model's other coefficients from a turntable, IEEE 1293");
  verb.add_option("FILE", command.files,
                  "positions (angle and output), or a recording that rests in them; - is standard "
                  "input (CSV)")
      ->type_name("")
      ->required();
  add_position_flags(verb, command);
  verb.add_flag("--rotating", command.rotating,
                "the sensor sat on a wheel that turned: scale factor and bias from its turns");
  verb.add_option("--coefficients", command.coefficients,
                  "fit these coefficients of the whole model equation")
      ->type_name("K0,K1...")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--update-sensor", command.update_sensor,
                  "write bias and scale into this sensor file")
      ->type_name("FILE.toml");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the positions with fit and residuals");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass tumble positions.csv --unit g --report tumble.html");
}

void add_flags(CLI::App& app, SensorCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "sensor", "a sensor file's figures: shown, compared, or for other programs");
  verb.add_option("ACTION", command.action, "show FILE, diff OLD NEW, or export FILE")
      ->type_name("")
      ->check(CLI::IsMember({"show", "diff", "export"}))
      ->required();
  verb.add_option("FILE", command.files, "sensor files, TOML")
      ->type_name("")
      ->expected(1, 2)
      ->required();
  verb.add_option("--format", command.format,
                  "export: imu-yaml, for visual-inertial calibration, or c-header, for firmware")
      ->type_name("NAME")
      ->check(CLI::IsMember({"imu-yaml", "c-header"}));
  verb.add_option("--rate", command.rate_hz, "export, imu-yaml: of the recordings to come")
      ->type_name("HZ")
      ->check(positive());
  verb.add_option("--rostopic", command.rostopic, "export, imu-yaml: their topic (default /imu0)")
      ->type_name("NAME");
  verb.add_option("-o,--output", command.output.output,
                  "export: the new file (default: standard output)")
      ->type_name("FILE")
      ->group("Output");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n  proofmass sensor show rim.toml\n"
      "  proofmass sensor diff rim-2025.toml rim.toml --report change.html\n"
      "  proofmass sensor export rim.toml --format imu-yaml --rate 100 -o imu.yaml");
}

}  // namespace proofmass::app
