#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <memory>

#include "config_file.hpp"
#include "exit_status.hpp"
#include "proofmass/core/version.hpp"

namespace proofmass::app {
namespace {

// Names the positionals the way people do: "FILE...", "[RIG]".
class Formatter : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_usage(const CLI::Option* option) const override {
    const std::string name = option->get_name(true) + (option->get_expected_max() > 1 ? "..." : "");
    return option->get_required() ? name : "[" + name + "]";
  }
};

// CLI11's own validators print bounds of 309 digits.
CLI::Validator number(const char* expected, bool (*fits)(double)) {
  const auto check = [expected, fits](std::string& text) -> std::string {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && std::isfinite(value) && fits(value)) return {};
    return fmt::format("expected {}, not '{}'", expected, text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator positive() {
  return number("a number above 0", [](double x) { return x > 0.0; });
}
CLI::Validator finite() {
  return number("a number", [](double) { return true; });
}
CLI::Validator not_negative() {
  return number("a number of 0 or more", [](double x) { return x >= 0.0; });
}
CLI::Validator latitude() {
  return number("degrees from -90 to 90", [](double x) { return std::abs(x) <= 90.0; });
}

void add_input_flags(CLI::App& verb, InputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Input");
  };
  add("--rate", flags.rate_hz, "HZ", "sample rate, where the file has no time column")
      ->check(positive());
  add("--unit", flags.unit, "UNIT", "of the accelerometer channels: g, mg, m/s2, V, mV or counts")
      ->check(CLI::IsMember({"g", "mg", "m/s2", "V", "mV", "counts"}));
  add("--channel", flags.channels, "NAME", "use this channel; may be repeated (default: all)")
      ->allow_extra_args(false);
  add("--variable", flags.variables, "NAME",
      "of a MAT file, read this variable; may be repeated (default: the largest)")
      ->allow_extra_args(false);
  add("--time", flags.time, "NAME", "the time column (default: found by name and content)");
  add("--from", flags.from_s, "S", "leave out what comes before")->check(finite());
  add("--to", flags.to_s, "S", "leave out what comes from here on")->check(finite());
  CLI::Option* sensor =
      add("--sensor", flags.sensors, "FILE.toml",
          "apply this sensor file's calibration first; once for all sensors or once for each");
  sensor->allow_extra_args(false);
  add("--supply", flags.supply_v, "V", "the ratiometric sensor's supply, instead of the file's")
      ->check(positive())
      ->needs(sensor);
  CLI::Option* gravity =
      add("--gravity", flags.gravity_mps2, "M_PER_S2", "local gravity (default 9.80665)");
  gravity->check(positive());
  CLI::Option* where = add("--latitude", flags.latitude_deg, "DEG", "gravity from the latitude");
  where->check(latitude())->excludes(gravity);
  add("--height", flags.height_m, "M", "and from the height above the ellipsoid")
      ->check(finite())
      ->needs(where);
}

void add_switch_on_flag(CLI::App& verb, InputFlags& flags, const char* help) {
  verb.add_option("--since-switch-on", flags.since_switch_on_s, help)
      ->type_name("S")
      ->group("Input")
      ->check(not_negative());
}

void add_output_flags(CLI::App& verb, OutputFlags& flags) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->group("Output");
  };
  add("--json", flags.json, "FILE", "write the results as JSON; - is standard output, alone");
  verb.add_flag("-q,--quiet", flags.quiet, "say nothing on standard error but an error")
      ->group("Output");
  verb.add_flag("-v,--verbose", flags.verbose, "tell what was found while reading")
      ->group("Output");
  verb.add_flag("--strict", flags.strict, "exit with status 5 if the data are bad")
      ->group("Output");
  // Read before all others, by config_path(); here it stands for --help.
  verb.add_option("--config", "read flags from this file")->type_name("FILE.toml")->group("Output");
}

void add_report_flag(CLI::App& verb, OutputFlags& flags) {
  verb.add_option("--report", flags.report, "write one self-contained page with the plots")
      ->type_name("FILE.html")
      ->group("Output");
}

CLI::Option* add_output_file(CLI::App& verb, OutputFlags& flags, const char* help) {
  return verb.add_option("-o,--output", flags.output, help)->type_name("FILE.csv")->group("Output");
}

// The verbs, each bound to its command.
struct Commands {
  InspectCommand inspect;
  ConvertCommand convert;
  WheelCommand wheel;
  NoiseCommand noise;
  DriftCommand drift;
  CalibrateCommand calibrate;
  TumbleCommand tumble;
  SimulateCommand simulate;
  BudgetCommand budget;
  SensorCommand sensor;
};

void add_inspect(CLI::App& app, InspectCommand& command) {
  CLI::App& verb = *app.add_subcommand("inspect", "what is in a file and how good it is");
  verb.add_option("FILE", command.files, "recordings; - is standard input (CSV)")
      ->type_name("")
      ->required();
  add_input_flags(verb, command.input);
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass inspect wheel.csv --report wheel.html");
}

void add_convert(CLI::App& app, ConvertCommand& command) {
  CLI::App& verb = *app.add_subcommand("convert", "between formats");
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  add_output_file(verb, command.output, "the new file: .csv, .csv.gz or .npy; - is CSV")
      ->required();
  add_input_flags(verb, command.input);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass convert log.csv.xz --unit mg -o log.npy");
}

void add_wheel(CLI::App& app, WheelCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "wheel", "angle, turns and speed from one or two accelerometers on a wheel");
  verb.add_option("FILE", command.files, "one recording, or one for each of two sensors")
      ->type_name("")
      ->expected(1, 2)
      ->required();
  verb.add_option("--spin-axis", command.spin_axis,
                  "x, y, z, -x, -y, -z or \"X,Y,Z\" in the sensor's axes (default: found)")
      ->type_name("AXIS");
  verb.add_option("--radius", command.radius_m, "of the sensor from the axle, where known")
      ->type_name("M")
      ->check(not_negative());
  verb.add_option(
          "--rolling-radius", command.rolling_radius_m,
          "on which the wheel rolls under a vehicle: takes its speeding up out of the angle")
      ->type_name("M")
      ->check(positive());
  verb.add_option("--rim-radius", command.rim_radius_m, "of the rim, whose path is the distance")
      ->type_name("M")
      ->check(positive());
  add_input_flags(verb, command.input);
  add_switch_on_flag(
      verb, command.input,
      "the sensors had been on so long at the file's first sample: takes the warm-up "
      "that their sensor files know of out");
  add_output_file(verb, command.output, "write the whole time series with standard deviations");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass wheel hub.csv rim.csv --spin-axis z --report wheel.html");
}

void add_noise(CLI::App& app, NoiseCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "noise", "Allan deviation, spectrum and noise figures of a sensor at rest");
  verb.add_option("FILE", command.files, "recordings at rest; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--statistic", command.statistic, "NAME",
      "oadev (default), adev, mdev, tdev, hdev, ohdev, totdev, mtotdev, ttotdev, htotdev, theo1 or "
      "pdev");
  add("--taus", command.taus, "LIST",
      "octave, decade, all, N-per-decade (default 16) or seconds \"1,2,10\"");
  add("--stop-ratio", command.stop_ratio, "X",
      "length of the recording over the longest averaging time (default: the statistic's)")
      ->check(number("a number of 1 or more", [](double x) { return x >= 1.0; }));
  add("--data", command.data, "KIND", "rate (default), or phase: the integral of it over time")
      ->check(CLI::IsMember({"rate", "phase"}));
  add("--confidence", command.confidence, "P", "of the deviation's limits (default 0.683)")
      ->check(number("a number between 0 and 1", [](double x) { return x > 0.0 && x < 1.0; }));
  add("--noise-type", command.noise_type, "TYPE",
      "on which the limits hang: auto (default), lag1, or the power of f from -4 to 2");
  verb.add_flag("--exclude-events", command.exclude_events,
                "leave out knocks, and whatever reaches across a step");
  add("--temperature", command.temperature, "NAME",
      "take out what follows this channel, by least squares");
  add("--update-sensor", command.update_sensor, "FILE.toml",
      "write the figures into this sensor file");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the deviation curves");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass noise rest.csv --rate 100 --unit g --report noise.html");
}

void add_drift(CLI::App& app, DriftCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "drift", "warm-up of the bias of a sensor at rest, and whether the recording can tell");
  verb.add_option("FILE", command.files,
                  "recordings at rest from switching on; three or more are compared as power-ups; "
                  "- is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--forecast", command.forecast_s, "S", "foretell the bias so long after switching on")
      ->check(not_negative());
  add("--temperature", command.temperature, "NAME",
      "fit the bias against this channel (default: the only one in a unit of temperature); none: "
      "do not");
  add("--update-sensor", command.update_sensor, "FILE.toml",
      "write what is identified into this sensor file");
  add_input_flags(verb, command.input);
  add_switch_on_flag(verb, command.input,
                     "how long the sensor had been on at the first sample (default 0)");
  add_output_file(
      verb, command.output,
      "write block means, curve, its standard deviation, and the bias less white noise");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass drift rest.csv --rate 100 --unit g --report drift.html");
}

constexpr const char* gravity_std_help =
    "standard deviation of gravity (default: 0 of --gravity, 4e-4 of --latitude, else 0.015)";

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

void add_calibrate(CLI::App& app, CalibrateCommand& command) {
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
  add("--indexing-std", command.indexing_std_deg, "DEG", "standard deviation of the table's angles")
      ->check(not_negative());
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
}

void add_tumble(CLI::App& app, TumbleCommand& command) {
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
      ->type_name("K0,K1,…")
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

void add_procedure_flags(CLI::App& verb, SimulateCommand& command) {
  CLI::Option* procedure =
      verb.add_option("--procedure", command.procedure,
                      "a calibration instead of the rig: tumble, four-position, six-position or "
                      "multi-position");
  procedure->type_name("NAME")->check(
      CLI::IsMember({"tumble", "four-position", "six-position", "multi-position"}));
  const auto add = [&](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type)->needs(procedure)->group("Procedure");
  };
  add("--session", command.session, "N", "same sensor and table, other noise and hand")
      ->check(not_negative());
  add("--positions", command.positions, "N", "of tumble (default 24) or multi-position (24)");
  add("--dwell", command.dwell_s, "S", "in each position")->check(positive());
  add("--supply", command.supply_v, "V", "of the ratiometric sensor (default 3.3)")
      ->check(positive());
  add("--signal", command.signal, "KIND", "acceleration (default), voltage or counts")
      ->check(CLI::IsMember({"acceleration", "voltage", "counts"}));
}

void add_simulate(CLI::App& app, SimulateCommand& command) {
  CLI::App& verb = *app.add_subcommand("simulate", "the rig, or a calibration, as a digital twin");
  verb.add_option("RIG", command.rig, "description, TOML (default: the thesis's rig)")
      ->type_name("");
  verb.add_option("--seed", command.seed, "same seed, same numbers")
      ->type_name("N")
      ->check(not_negative());
  verb.add_option("--rpm", command.rpm, "turn at this speed throughout")
      ->type_name("RPM")
      ->check(finite());
  verb.add_option("--rate", command.rate_hz, "samples a second")
      ->type_name("HZ")
      ->check(positive());
  verb.add_option("--duration", command.duration_s, "length of the recording")
      ->type_name("S")
      ->check(positive());
  verb.add_option("--gravity", command.gravity_mps2, "local gravity (default 9.80665)")
      ->type_name("M_PER_S2")
      ->check(positive());
  verb.add_flag("--datasheet-errors", command.datasheet_errors,
                "misalignment, cross-axis, scale and nonlinearity as the datasheet allows");
  verb.add_option("--adc-bits", command.adc_bits, "of the converter")->type_name("N");
  verb.add_flag("--print-config", command.print_config, "print the description and stop");
  add_procedure_flags(verb, command);
  add_output_file(verb, command.output,
                  "the recording; the truth goes to FILE.truth.csv; - is standard output");
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n  proofmass simulate --rpm 15 --seed 7 -o rig.csv\n"
      "  proofmass simulate --procedure multi-position -o poses.csv");
}

void add_budget(CLI::App& app, BudgetCommand& command) {
  CLI::App& verb = *app.add_subcommand("budget", "position error against time for a sensor");
  CLI::Option* bias =
      verb.add_option("--bias-mg", command.bias_mg, "bias that is left; may be repeated");
  bias->type_name("MG")->delimiter(',')->allow_extra_args(false)->check(finite());
  verb.add_option("--sensor", command.sensors, "take bias and noise from this sensor file")
      ->type_name("FILE.toml")
      ->allow_extra_args(false);
  verb.add_option("--times", command.times_s, "after these times (default 1,10,60,3600)")
      ->type_name("S,…")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(not_negative());
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass budget --bias-mg 3 --times 1,10,60");
}

void add_sensor(CLI::App& app, SensorCommand& command) {
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

// The value of --config, if it is given.
std::string config_path(const std::vector<std::string>& arguments) {
  constexpr std::string_view flag = "--config";
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k] == flag && k + 1 < arguments.size()) return arguments[k + 1];
    if (arguments[k].starts_with(std::string(flag) + "="))
      return arguments[k].substr(flag.size() + 1);
  }
  return {};
}

bool is_given(const CLI::Option& option, const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name.starts_with("--")) return option.check_lname(name.substr(2));
    return name.size() > 1 && name.front() == '-' && option.check_sname(name.substr(1, 1));
  });
}

CLI::App* find_verb(CLI::App& app, const std::string& name) {
  const auto verbs = app.get_subcommands([&](CLI::App* verb) { return verb->get_name() == name; });
  return verbs.empty() ? nullptr : verbs.front();
}

bool known_to_any(CLI::App& app, const std::string& flag) {
  const auto verbs = app.get_subcommands([](CLI::App*) { return true; });
  return std::any_of(verbs.begin(), verbs.end(), [&](CLI::App* verb) {
    return verb->get_option_no_throw("--" + flag) != nullptr;
  });
}

// The option that an entry is for; nullptr if it is none of this verb's business.
const CLI::Option* option_for(CLI::App& app,
                              CLI::App& verb,
                              const ConfigEntry& entry,
                              const std::string& place) {
  if (!entry.verb.empty() && find_verb(app, entry.verb) == nullptr) {
    throw Failure(usage, place + "[" + entry.verb + "] is no verb");
  }
  if (!entry.verb.empty() && entry.verb != verb.get_name()) return nullptr;
  const bool about_itself = entry.flag == "config" || entry.flag == "help";
  const CLI::Option* option = about_itself ? nullptr : verb.get_option_no_throw("--" + entry.flag);
  const bool elsewhere = !about_itself && entry.verb.empty() && known_to_any(app, entry.flag);
  if (option == nullptr && !elsewhere) {
    throw Failure(usage, fmt::format("{}{} has no flag '{}': see proofmass {} --help", place,
                                     verb.get_name(), entry.flag, verb.get_name()));
  }
  return option;
}

// The entry as it would stand on the command line.
std::vector<std::string> as_arguments(const CLI::Option& option,
                                      const ConfigEntry& entry,
                                      const std::string& place) {
  std::vector<std::string> arguments;
  const bool is_switch = option.get_items_expected_max() == 0;
  for (const std::string& value : entry.values) {
    if (is_switch && value != "true" && value != "false") {
      throw Failure(usage, place + entry.flag + ": expected true or false, not '" + value + "'");
    }
    if (!is_switch) arguments.push_back("--" + entry.flag + "=" + value);
    if (is_switch && value == "true") arguments.push_back("--" + entry.flag);
  }
  return arguments;
}

// The flags that the configuration file adds to those given, which go before it.
std::vector<std::string> configured(CLI::App& app,
                                    CLI::App& verb,
                                    const std::vector<std::string>& arguments) {
  std::vector<std::string> more;
  const std::string path = config_path(arguments);
  if (path.empty()) return more;
  for (const ConfigEntry& entry : read_config(path)) {
    const std::string place = fmt::format("{}: line {}: ", path, entry.line);
    const CLI::Option* option = option_for(app, verb, entry, place);
    if (option == nullptr || is_given(*option, arguments)) continue;
    for (std::string& argument : as_arguments(*option, entry, place)) {
      more.push_back(std::move(argument));
    }
  }
  return more;
}

std::vector<std::string> with_config(CLI::App& app, int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    CLI::App* verb = find_verb(app, arguments[k]);
    if (verb == nullptr) continue;
    const std::vector<std::string> more = configured(app, *verb, arguments);
    arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(k) + 1, more.begin(),
                     more.end());
    break;
  }
  return arguments;
}

Command chosen(CLI::App& app, Commands& commands) {
  if (app.got_subcommand("inspect")) return std::move(commands.inspect);
  if (app.got_subcommand("convert")) return std::move(commands.convert);
  if (app.got_subcommand("wheel")) return std::move(commands.wheel);
  if (app.got_subcommand("noise")) return std::move(commands.noise);
  if (app.got_subcommand("drift")) return std::move(commands.drift);
  if (app.got_subcommand("calibrate")) return std::move(commands.calibrate);
  if (app.got_subcommand("tumble")) return std::move(commands.tumble);
  if (app.got_subcommand("simulate")) return std::move(commands.simulate);
  if (app.got_subcommand("sensor")) return std::move(commands.sensor);
  return std::move(commands.budget);
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::optional<Command> parse_command_line(int argc, char** argv) {
  CLI::App app(
      "Puts an accelerometer to the proof: from raw readings to angle, turns and speed with "
      "honest error bars.",
      "proofmass");
  app.set_version_flag("--version", fmt::format("proofmass {}", version()));
  app.require_subcommand(1);
  app.formatter(std::make_shared<Formatter>());
  app.get_formatter()->column_width(34);
  app.footer("Each verb explains itself: proofmass VERB --help");
  Commands commands;
  add_inspect(app, commands.inspect);
  add_convert(app, commands.convert);
  add_wheel(app, commands.wheel);
  add_noise(app, commands.noise);
  add_drift(app, commands.drift);
  add_calibrate(app, commands.calibrate);
  add_tumble(app, commands.tumble);
  add_simulate(app, commands.simulate);
  add_budget(app, commands.budget);
  add_sensor(app, commands.sensor);
  std::vector<std::string> arguments = with_config(app, argc, argv);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error, std::cout, std::cerr);
      return std::nullopt;
    }
    const auto used = app.get_subcommands();
    const std::string verb = used.empty() ? "" : used.front()->get_name() + " ";
    throw Failure(usage, fmt::format("{}: see proofmass {}--help", one_line(error.what()), verb));
  }
  return chosen(app, commands);
}

std::array<double, 3> parse_axis(const std::string& text) {
  const bool minus = text.starts_with('-');
  const std::string letter = text.substr(minus || text.starts_with('+') ? 1 : 0);
  const double sign = minus ? -1.0 : 1.0;
  if (letter == "x") return {sign, 0.0, 0.0};
  if (letter == "y") return {0.0, sign, 0.0};
  if (letter == "z") return {0.0, 0.0, sign};
  std::array<double, 3> axis{};
  const char* from = text.data();
  const char* end = from + text.size();
  bool good = true;
  for (std::size_t k = 0; k < 3 && good; ++k) {
    const auto [stop, error] = std::from_chars(from, end, axis[k]);
    good = error == std::errc() && std::isfinite(axis[k]) &&
           (k == 2 ? stop == end : stop != end && *stop == ',');
    from = stop + 1;
  }
  if (!good || std::hypot(axis[0], axis[1], axis[2]) == 0.0) {
    throw Failure(
        usage,
        "--spin-axis: expected x, y, z, -x, -y, -z or three numbers \"0,0,1\", not '" + text + "'");
  }
  return axis;
}

}  // namespace proofmass::app
