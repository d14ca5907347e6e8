#include "flags.hpp"
#include "verb_flags.hpp"

namespace proofmass::app {

void add_flags(CLI::App& app, InspectCommand& command) {
  CLI::App& verb = *app.add_subcommand("inspect", "what is in a file and how good it is");
  verb.add_option("FILE", command.files, "recordings: files or folders; - is standard input")
      ->type_name("")
      ->required();
  add_input_flags(verb, command.input);
  verb.add_flag("--pyramid", command.pyramid,
                "store the smallest and largest values at every scale beside each file, as "
                "FILE.pyramid.npz, for pictures of any stretch without reading it again");
  add_report_flag(verb, command.output);
  add_output_flags(verb, command.output);
  add_memory_flag(verb, command.input);
  verb.footer("Example:\n  proofmass inspect wheel.csv --report wheel.html");
}

void add_flags(CLI::App& app, ConvertCommand& command) {
  CLI::App& verb = *app.add_subcommand("convert", "between formats");
  verb.add_option("FILE", command.file, "a recording: a file or a folder; - is standard input")
      ->type_name("")
      ->required();
  add_output_file(
      verb, command.output,
      "the new file: .csv, .csv.gz, .npy, .mat, .tdms, .h5, .mcap or .parquet; - is CSV")
      ->required();
  add_input_flags(verb, command.input);
  add_output_flags(verb, command.output);
  add_memory_flag(verb, command.input);
  verb.footer("Example:\n  proofmass convert log.csv.xz --unit mg -o log.npy");
}

void add_flags(CLI::App& app, WheelCommand& command) {
  CLI::App& verb = *app.add_subcommand(
      "wheel", "angle, turns and speed from one or two accelerometers on a wheel");
  verb.add_option("FILE", command.files, "one recording, or one for each of two sensors")
      ->type_name("")
      ->expected(1, 2)
      ->required();
  verb.add_option("--spin-axis", command.spin_axis,
                  "x, y, z, -x, -y, -z or \"X,Y,Z\" in the sensor's axes (default: found)")
      ->type_name("AXIS");
  CLI::Option* radius =
      verb.add_option("--radius", command.radius_m, "of the sensor from the axle, where known")
          ->type_name("M")
          ->check(not_negative());
  verb.add_option("--radius-std", command.radius_std_m,
                  "standard deviation of --radius (default: 2 %, at least 0.0002)")
      ->type_name("M")
      ->check(not_negative())
      ->needs(radius);
  verb.add_option("--bandwidth", command.bandwidth_hz,
                  "-3 dB of the sensor's filter, which delays the angle (default: of the --sensor "
                  "file, or anywhere from 6 Hz to 2.5 times the rate)")
      ->type_name("HZ")
      ->check(positive());
  verb.add_option("--axle-tilt-std", command.axle_tilt_std_deg,
                  "standard deviation of the axle from level (default 5)")
      ->type_name("DEG")
      ->check(not_negative());
  verb.add_flag("--no-gyro", command.no_gyro, "leave the gyroscope's channels alone");
  verb.add_option("--rate-unit", command.rate_unit,
                  "of the gyroscope, where its heading has none: rad/s (default) or deg/s")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
  verb.add_option("--rolling-radius", command.rolling_radius_m,
                  "on which the wheel rolls under a vehicle (0: on a bench): takes its speeding up "
                  "out of the angle")
      ->type_name("M")
      ->check(not_negative());
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

void add_flags(CLI::App& app, NoiseCommand& command) {
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
      "pdev")
      ->check(CLI::IsMember({"oadev", "adev", "mdev", "tdev", "hdev", "ohdev", "totdev", "mtotdev",
                             "ttotdev", "htotdev", "theo1", "pdev"}));
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
  add_memory_flag(verb, command.input);
  verb.footer("Example:\n  proofmass noise rest.csv --rate 100 --unit g --report noise.html");
}

void add_flags(CLI::App& app, DriftCommand& command) {
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
  add("--order", command.order, "ORDER",
      "of three files or more: time (default: by their absolute time stamps, else by the numbers "
      "in "
      "their names) or given (as on the command line)")
      ->check(CLI::IsMember({"time", "given"}));
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

}  // namespace proofmass::app
