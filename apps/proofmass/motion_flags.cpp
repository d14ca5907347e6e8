#include "flags.hpp"
#include "verb_flags.hpp"

namespace proofmass::app {

void add_flags(CLI::App& app, TiltCommand& command) {
  CLI::App& verb =
      *app.add_subcommand("tilt", "roll and pitch from gravity, at rest and on a moving base");
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--base", command.base, "KIND",
      "auto (default): still if it rests nearly throughout; still, or moving")
      ->check(CLI::IsMember({"auto", "still", "moving"}));
  add("--reads", command.reads, "SIGN",
      "what an axis that points up reads at rest: +g (default), or -g as on an iPhone")
      ->check(CLI::IsMember({"+g", "-g"}));
  add("--gyro", command.gyro, "NAME",
      "the gyroscope's channels for x, y and z: three of them (default: found by name and unit)")
      ->allow_extra_args(false);
  verb.add_flag("--no-gyro", command.no_gyro, "leave the gyroscope's channels alone");
  add("--rate-unit", command.rate_unit, "UNIT",
      "of the gyroscope, where its heading has none: rad/s (default) or deg/s")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
  add("--shortest-rest", command.shortest_rest_s, "S",
      "a rest lasts at least so long (default 0.5)")
      ->check(positive());
  add("--bias-std", command.bias_std_mps2, "M_PER_S2",
      "standard deviation of each axis' bias; with a --sensor file, of what it has changed by "
      "since "
      "the calibration (default: judged by the force at rest)")
      ->check(not_negative());
  add("--gravity-std", command.gravity_std_mps2, "M_PER_S2", gravity_std_help)
      ->check(not_negative());
  CLI::Option* angle =
      add("--angle", command.angle, "COLUMN",
          "the recording holds an angle instead of accelerations, in this column (name or number, "
          "1 being the first)");
  add("--rate-channel", command.rate_channel, "COLUMN",
      "and the gyroscope's rate about the same axis in this one")
      ->needs(angle);
  add("--angle-unit", command.angle_unit, "UNIT",
      "of that column, where its heading has none: rad (default) or deg")
      ->check(CLI::IsMember({"rad", "deg"}))
      ->needs(angle);
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output,
                  "write roll and pitch against time with standard deviations");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass tilt lying.csv --sensor sensor.toml\n"
      "  proofmass tilt drive.csv --base moving --report tilt.html\n"
      "  proofmass tilt motor.dat --angle 3 --rate-channel 2");
}

namespace {

// A number as of the other verbs, or a word.
CLI::Validator gravity_value() {
  const CLI::Validator number = positive();
  const auto check = [number](std::string& text) -> std::string {
    if (text == "removed" || text == "present" || number(text).empty()) return {};
    return "expected removed, present or a number above 0, not '" + text + "'";
  };
  return CLI::Validator(check, "");
}

void add_track_flags(CLI::App& verb, TrackCommand& command) {
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--model", command.model, "MODEL",
      "inertial (default): the acceleration is integrated between stops, which holds for a motion "
      "of any kind; pva: it is estimated, as one that white jerk drives, and NIS judges each "
      "sample; fused: the same from 2 to 4 accelerometers with parallel axes")
      ->check(CLI::IsMember({"inertial", "pva", "fused"}));
  add("--jerk-psd", command.jerk_psd_m2ps5, "M2_PER_S5",
      "density of that jerk (default: by maximum likelihood)")
      ->check(positive());
  add("--axis", command.axis, "AXIS",
      "direction of the displacement: x, y, z, with a sign, or X,Y,Z in the sensor's axes, with a "
      "gyroscope the world's (default: along which it moved farthest)");
  CLI::Option* same = verb.add_flag("--same-place", command.same_place, "it ended where it began");
  add("--same-place-std", command.same_place_std_m, "M", "how well (default 0.001)")
      ->check(positive())
      ->needs(same);
  CLI::Option* fixes = add("--fixes", command.fixes, "FILE.csv",
                           "positions measured on the way: time, position and, if known, std");
  add("--fix-std", command.fix_std_m, "M", "of those without their own (default 0.01)")
      ->check(positive())
      ->needs(fixes);
  CLI::Option* still = add("--still", command.still, "FILE",
                           "list of intervals in which it stood still, instead of those found");
  add("--rests", command.rests, "WHICH",
      "which quiet stretches are rests: found (default: as they fit the motion), or ends: the "
      "first "
      "and the last alone")
      ->check(CLI::IsMember({"found", "ends"}))
      ->excludes(still);
  add("--turns", command.turns, "FILE", "list of times at which it turned round: velocity 0");
  add("--shortest-rest", command.shortest_rest_s, "S",
      "a rest lasts at least so long (default 0.5)")
      ->check(positive());
  add("--rest-speed-std", command.rest_speed_std_mps, "M_PER_S",
      "speed that a sensor at rest may have (default 0.0001)")
      ->check(positive());
  add("--scale-std", command.scale_std, "SHARE",
      "relative standard deviation of the readings' scale (default: of the --sensor file, or by "
      "gravity at rest)")
      ->check(not_negative());
  verb.add_flag("--take-as-acceleration", command.take_as_acceleration,
                "give a displacement though the readings look like jerk");
  verb.add_flag("--no-gyro", command.no_gyro, "leave the gyroscope's channels alone");
  add("--rate-unit", command.rate_unit, "UNIT",
      "of the gyroscope, where its heading has none: rad/s (default) or deg/s")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
}

}  // namespace

void add_flags(CLI::App& app, TrackCommand& command) {
  CLI::App& verb =
      *app.add_subcommand("track", "displacement from acceleration, from rest to rest");
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  add_track_flags(verb, command);
  add_input_flags(verb, command.input);
  verb.remove_option(verb.get_option("--gravity"));
  verb.add_option(
          "--gravity", command.gravity,
          "removed or present, where the readings do not show it; or local gravity (default "
          "9.80665); may be repeated")
      ->type_name("WORD|M_PER_S2")
      ->allow_extra_args(false)
      ->check(gravity_value())
      ->group("Input");
  add_switch_on_flag(verb, command.input,
                     "how long the sensor had been on at the first sample: takes the warm-up of "
                     "the --sensor file out");
  add_output_file(verb, command.output,
                  "write position and velocity against time with standard deviations");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass track stroke.csv --report track.html\n"
      "  proofmass track phone.csv --gravity removed --same-place\n"
      "  proofmass track slide.csv --sensor sensor.toml --axis x --fixes tape.csv\n"
      "  proofmass track pair.csv --model fused --axis x");
}

void add_flags(CLI::App& app, TuneCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "tune",
      "Q, R and the bias's time constant of a filter from the recording that it is to run on");
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--model", command.model, "MODEL",
      "auto (default): rest if it rests nearly throughout, else pva; rest, rest-markov, pva, "
      "pva-bias, local-level, local-trend, position")
      ->check(CLI::IsMember({"auto", "rest", "rest-markov", "pva", "pva-bias", "local-level",
                             "local-trend", "position"}));
  add("--fix", command.fix, "NAME=VALUE", "hold a parameter, in SI; may be repeated")
      ->allow_extra_args(false);
  add("--share", command.share, "NAME",
      "one value of this parameter for all channels; may be "
      "repeated")
      ->allow_extra_args(false);
  verb.add_flag("--start-at-sensor", command.from_sensor,
                "start at the noise of the --sensor file instead of the Allan deviation");
  add("--study-step", command.study_step_s, "S",
      "step of the study of gain and covariance (default: the recording's)")
      ->check(positive());
  add("--update-sensor", command.update_sensor, "FILE.toml",
      "write white noise and random walk into this sensor file (model rest)");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the innovations with standard deviations");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass tune rest.csv --rate 100 --unit g\n"
      "  proofmass tune stroke.csv --model pva --share jerk_psd --report tune.html");
}

}  // namespace proofmass::app
