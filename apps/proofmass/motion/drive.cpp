#include "proofmass/estimate/drive.hpp"

#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "motion/drive_input.hpp"
#include "proofmass/report/drive/report.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct DriveCommand {
  DriveFiles named;
  std::vector<double> circumference_m;
  std::optional<double> circumference_std_m, track_m, track_std_m, wheelbase_m, wheelbase_std_m,
      bandwidth_hz;
  bool no_gyro = false;
  std::string rate_unit = "rad/s";
  std::string geojson;
  InputFlags input;
  OutputFlags output;
};

// Lengths of a vehicle: one in millimetres is refused.
CLI::Validator vehicle_length() {
  return number("metres, from 0.02 to 50", [](double x) { return x >= 0.02 && x <= 50.0; });
}

void add_vehicle_flags(CLI::App& verb, DriveCommand& command) {
  verb.add_option("--right", command.named.right, "recordings of the wheels on the right")
      ->type_name("FILE...");
  verb.add_option("--left", command.named.left, "recordings of the wheels on the left")
      ->type_name("FILE...");
  verb.add_option(
          "--front", command.named.front,
          "which of these wheels are on the steered axle (default: determined by the motion)")
      ->type_name("FILE...");
  verb.add_option("--frame", command.named.frame,
                  "recording of an inertial sensor on the vehicle's frame")
      ->type_name("FILE");
  verb.add_option("--gnss", command.named.gnss,
                  "position fixes: NMEA, or a table with latitude and longitude in degrees")
      ->type_name("FILE");
  CLI::Option* circumference =
      verb.add_option(
              "--circumference", command.circumference_m,
              "rolling circumference: one for all wheels, or one for each, those of --right "
              "first")
          ->type_name("M...")
          ->check(vehicle_length());
  verb.add_option("--circumference-std", command.circumference_std_m,
                  "its standard deviation (default: 0.3 %)")
      ->type_name("M")
      ->check(positive())
      ->needs(circumference);
  CLI::Option* track =
      verb.add_option("--track", command.track_m, "track width: between the wheels of an axle")
          ->type_name("M")
          ->check(vehicle_length());
  verb.add_option("--track-std", command.track_std_m, "its standard deviation (default: 2 %)")
      ->type_name("M")
      ->check(positive())
      ->needs(track);
  CLI::Option* wheelbase =
      verb.add_option("--wheelbase", command.wheelbase_m, "between the axles of a steered vehicle")
          ->type_name("M")
          ->check(vehicle_length());
  verb.add_option("--wheelbase-std", command.wheelbase_std_m,
                  "its standard deviation (default: 2 %)")
      ->type_name("M")
      ->check(positive())
      ->needs(wheelbase);
}

void add_drive_flags(CLI::App& verb, DriveCommand& command) {
  add_vehicle_flags(verb, command);
  verb.add_option("--counts-per-turn", command.named.counts_per_turn,
                  "counts per turn of wheels with an encoder instead of an accelerometer")
      ->type_name("N")
      ->check(positive());
  verb.add_option("--bandwidth", command.bandwidth_hz,
                  "-3 dB bandwidth of the accelerometers' filter")
      ->type_name("HZ")
      ->check(positive());
  verb.add_flag("--no-gyro", command.no_gyro, "do not use the gyroscopes' channels");
  verb.add_option("--rate-unit", command.rate_unit,
                  "unit of the gyroscopes if their heading has none: rad/s (default) or deg/s")
      ->type_name("UNIT")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
  verb.add_option("--geojson", command.geojson, "write the path as GeoJSON; needs --gnss")
      ->type_name("FILE");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the path with standard deviations");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Example:\n  proofmass drive --right rr.csv --left rl.csv --gnss fixes.csv --track 1.5 "
      "--report drive.html");
}

std::optional<Uncertain> given(const std::optional<double>& value,
                               const std::optional<double>& std,
                               double usual_share) {
  if (!value) return std::nullopt;
  return Uncertain{*value, std.value_or(usual_share * *value)};
}

void set_circumferences(const DriveCommand& command, std::vector<estimate::DriveWheel>& wheels) {
  const std::vector<double>& given_m = command.circumference_m;
  if (given_m.empty()) return;
  if (given_m.size() != 1 && given_m.size() != wheels.size())
    throw Failure(usage,
                  fmt::format("--circumference: {} values for {} wheels, expected one, or one "
                              "for each",
                              given_m.size(), wheels.size()));
  for (std::size_t i = 0; i < wheels.size(); ++i)
    wheels[i].circumference_m =
        given(given_m[given_m.size() == 1 ? 0 : i], command.circumference_std_m, 0.003);
}

// Offsets of the clocks' readings, as offsets of the times since each file's first sample.
void count_from_first_samples(const std::vector<double>& begin_s,
                              estimate::DriveSolution& solution) {
  std::size_t at = 0;
  const auto shift = [&](std::optional<Uncertain>& offset) {
    if (offset) offset->value += begin_s.front() - begin_s[at];
    ++at;
  };
  for (estimate::DriveWheelFit& wheel : solution.wheels) shift(wheel.clock_offset_s);
  if (solution.frame_clock_offset_s) shift(solution.frame_clock_offset_s);
}

void run_drive(const DriveCommand& command) {
  report::DriveReport report;
  for (const auto* files : {&command.named.right, &command.named.left})
    report.inputs.insert(report.inputs.end(), files->begin(), files->end());
  for (const std::string& file : {command.named.frame, command.named.gnss})
    if (!file.empty()) report.inputs.push_back(file);
  if (!command.geojson.empty() && command.named.gnss.empty())
    throw Failure(usage, "--geojson: a path has coordinates on Earth only with --gnss FILE");
  DriveInput input = drive_input(command.named, command.input,
                                 {!command.no_gyro, command.rate_unit}, command.output);
  report.notes = std::move(input.notes);
  set_circumferences(command, input.wheels);
  estimate::DriveOptions options;
  options.wheel.gravity_mps2 = gravity_mps2(command.input);
  options.wheel.bandwidth_hz = command.bandwidth_hz;
  options.track_m = given(command.track_m, command.track_std_m, 0.02);
  options.wheelbase_m = given(command.wheelbase_m, command.wheelbase_std_m, 0.02);
  options.progress = progress_bar(command.output);
  report.solution = need(estimate::estimate_drive(input.wheels, input.frame, input.fixes, options),
                         Stage::computing);
  options.progress = {};
  count_from_first_samples(input.begin_s, report.solution);
  if (!command.geojson.empty())
    write_text(command.geojson, report::drive_geojson(report), command.output);
  finish(report::describe(report), [&] { return report::drive_series(report); }, command.output);
}

}  // namespace

Verb drive_verb() {
  return make_verb<DriveCommand>(
      {.name = "drive",
       .group = "Estimate",
       .help = "path of a vehicle from sensors on its wheels, with or without position fixes"},
      add_drive_flags, run_drive);
}

}  // namespace proofmass::app
