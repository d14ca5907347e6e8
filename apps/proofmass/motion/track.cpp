#include "proofmass/estimate/track.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "input/sensor_options.hpp"
#include "proofmass/io/positions/instant_list.hpp"
#include "proofmass/io/positions/interval_list.hpp"
#include "proofmass/report/track/report.hpp"
#include "proofmass/sensor/warm_up.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

/// Displacement from one accelerometer, or from several that are fused.
struct TrackCommand {
  std::string file;
  std::string model = "inertial";  ///< or pva, fused
  std::optional<double> jerk_psd_m2ps5;
  std::vector<std::string> gravity;  ///< a number in m/s^2, "removed" or "present", or both
  std::string axis;                  ///< empty: determined from the data
  bool same_place = false;
  double same_place_std_m = 1e-3;
  std::string fixes, still, turns;  ///< files: positions, intervals, times of velocity 0
  std::string rests = "found";
  double fix_std_m = 0.01;  ///< for fixes without their own
  std::optional<double> shortest_rest_s, scale_std;
  double rest_speed_std_mps = 1e-4;
  bool take_as_acceleration = false, no_gyro = false;
  std::string rate_unit = "rad/s";
  InputFlags input;
  OutputFlags output;
};

// A number as for the other verbs, or a word.
CLI::Validator gravity_value() {
  const CLI::Validator number = positive();
  const auto check = [number](std::string& text) -> std::string {
    if (text == "removed" || text == "present" || number(text).empty()) return {};
    return "expected removed, present or a number above 0, not '" + text + "'";
  };
  return CLI::Validator(check, "");
}

void add_motion_flags(CLI::App& verb, TrackCommand& command) {
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
      "gyroscope the world's (default: direction of the largest motion)");
  CLI::Option* same =
      verb.add_flag("--same-place", command.same_place, "the motion ended at its starting point");
  add("--same-place-std", command.same_place_std_m, "M",
      "standard deviation of that (default 0.001)")
      ->check(positive())
      ->needs(same);
  CLI::Option* fixes = add("--fixes", command.fixes, "FILE.csv",
                           "known positions: time, position and, if known, std");
  add("--fix-std", command.fix_std_m, "M",
      "standard deviation of fixes without their own (default 0.01)")
      ->check(positive())
      ->needs(fixes);
  CLI::Option* still =
      add("--still", command.still, "FILE", "list of static intervals, instead of detection");
  add("--rests", command.rests, "WHICH",
      "quiet intervals used as rests: found (default: those consistent with the motion), or ends: "
      "the first "
      "and the last alone")
      ->check(CLI::IsMember({"found", "ends"}))
      ->excludes(still);
  add("--turns", command.turns, "FILE", "list of times of reversal: velocity 0");
  add("--shortest-rest", command.shortest_rest_s, "S", "minimum duration of a rest (default 0.5)")
      ->check(positive());
  add("--rest-speed-std", command.rest_speed_std_mps, "M_PER_S",
      "standard deviation of the speed at rest (default 0.0001)")
      ->check(positive());
  add("--scale-std", command.scale_std, "SHARE",
      "relative standard deviation of the scale (default: from the --sensor file, or from "
      "gravity at rest)")
      ->check(not_negative());
  verb.add_flag("--take-as-acceleration", command.take_as_acceleration,
                "integrate even if the data look like jerk");
  verb.add_flag("--no-gyro", command.no_gyro, "do not use the gyroscope's channels");
  add("--rate-unit", command.rate_unit, "UNIT",
      "unit of the gyroscope if its heading has none: rad/s (default) or deg/s")
      ->check(CLI::IsMember({"rad/s", "deg/s"}));
}

void add_track_flags(CLI::App& verb, TrackCommand& command) {
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  add_motion_flags(verb, command);
  add_input_flags(verb, command.input);
  verb.remove_option(verb.get_option("--gravity"));
  verb.add_option("--gravity", command.gravity,
                  "removed or present, if the data do not show it; or local gravity (default "
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
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass track stroke.csv --report track.html\n"
      "  proofmass track phone.csv --gravity removed --same-place\n"
      "  proofmass track slide.csv --sensor sensor.toml --axis x --fixes tape.csv\n"
      "  proofmass track pair.csv --model fused --axis x");
}

using estimate::GravityContent;
using estimate::TrackOptions;
using estimate::TrackSensor;

// A word states whether the measurements contain gravity, a number its magnitude.
void read_gravity(TrackCommand& command, TrackOptions& options) {
  for (const std::string& text : command.gravity) {
    const bool removed = text == "removed", present = text == "present";
    if (removed || present) {
      const GravityContent content = removed ? GravityContent::removed : GravityContent::present;
      if (options.gravity != GravityContent::unknown && options.gravity != content)
        throw Failure(usage, "--gravity: removed and present cannot both be true");
      options.gravity = content;
      continue;
    }
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    if (command.input.gravity_mps2) throw Failure(usage, "--gravity: expected one number at most");
    command.input.gravity_mps2 = value;
  }
  if (command.input.gravity_mps2 && command.input.latitude_deg)
    throw Failure(usage, "--gravity excludes --latitude");
  options.gravity_mps2 = gravity_mps2(command.input);
}

void expect_sense(const TrackCommand& command) {
  if (command.jerk_psd_m2ps5 && command.model == "inertial")
    throw Failure(usage, "--jerk-psd belongs to --model pva or fused");
  const bool from_stdin = command.file == "-";
  for (const std::string& list : {command.fixes, command.still, command.turns})
    if (from_stdin && list == "-")
      throw Failure(usage, "-: standard input is the recording: name a file for the list");
}

// A list that does not match the recording is reported as an error of the list.
void need_inside(const Status& inside, const std::string& file) {
  if (!inside) throw Failure(status_of(inside.error(), Stage::reading), inside.error().at(file));
}

void read_lists(const TrackCommand& command, const Recording& recording, TrackOptions& options) {
  if (!command.still.empty()) {
    const auto intervals = need(io::read_intervals(command.still), Stage::reading);
    need_inside(io::check_inside(intervals, recording.duration_s(), recording.samples()),
                command.still);
    for (const io::Interval& interval : intervals) {
      const auto time_of = [&](double end) {
        return interval.in_samples ? recording.time.at(static_cast<std::size_t>(end)) : end;
      };
      options.still.push_back({time_of(interval.start), time_of(interval.end)});
    }
  }
  if (!command.turns.empty()) {
    const auto turns = need(io::read_instants(command.turns), Stage::reading);
    need_inside(io::check_inside(turns, recording.duration_s()), command.turns);
    for (const io::Instant& turn : turns) options.turns_s.push_back(turn.time_s);
  }
}

// A tracker may run before and after the recording; if none of its fixes is inside, they count from
// something else.
void read_fixes(const TrackCommand& command,
                double duration_s,
                TrackOptions& options,
                std::vector<Note>& notes) {
  if (command.fixes.empty()) return;
  const auto all = need(io::read_instants(command.fixes), Stage::reading);
  auto fixes = all;
  const std::size_t outside = io::drop_outside(fixes, duration_s);
  if (fixes.empty()) need_inside(io::check_inside(all, duration_s), command.fixes);
  if (outside > 0)
    notes.push_back({Severity::warning,
                     fmt::format("{}: {} of {} fixes are before or after the recording, which has "
                                 "0 s to {:.6g} s, and are not used",
                                 command.fixes, outside, all.size(), duration_s)});
  for (const io::Instant& fix : fixes) {
    if (!fix.position_m)
      throw Failure(bad_input, command.fixes +
                                   ": no column of positions: expected a header such as time (s), "
                                   "position (m), std (m)");
    options.fixes.push_back({fix.time_s, *fix.position_m, fix.std_m.value_or(command.fix_std_m)});
  }
}

void take_from_sensor(const sensor::SensorModel& model,
                      bool warm_up_removed,
                      TrackOptions& options) {
  const estimate::AccelFigures figures = figures_of(model, warm_up_removed);
  options.white_mps2_rthz = figures.white_mps2_rthz;
  options.walk_mps2_rts = figures.walk_mps2_rts;
  options.warm_up_time_s = figures.warm_up_time_s;
  if (!options.scale_std) options.scale_std = scale_std_of(model.calibration);
}

// One; for the model `fused` two to four.
std::vector<Accelerometer> chosen_accelerometers(const TrackCommand& command,
                                                 const std::vector<Recording>& recordings) {
  std::vector<Accelerometer> found = accelerometers(recordings);
  const bool fused = command.model == "fused";
  if (fused ? found.size() > 1 && found.size() <= estimate::most_fused_sensors : found.size() == 1)
    return found;
  std::string names;
  for (const Accelerometer& one : found) names += (names.empty() ? "" : ", ") + one.triad.name;
  throw Failure(usage,
                fmt::format("{}: {} accelerometer{} ({}), expected {}: choose with --channel{}",
                            recordings.front().source, found.size(), found.size() == 1 ? "" : "s",
                            names, fused ? "2 to 4" : "one",
                            fused ? "" : ", or fuse 2 to 4 that are parallel with --model fused"));
}

std::array<std::vector<double>, 3> readings_of(const Recording& recording, const Triad& triad) {
  std::array<std::vector<double>, 3> readings;
  const std::array axes{triad.x, triad.y, triad.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axes[axis]) readings[axis] = recording.channels[*axes[axis]].values.copy();
  return readings;
}

TrackSensor sensor_of(const TrackCommand& command,
                      const Recording& recording,
                      const Accelerometer& from,
                      const sensor::SensorModel* model,
                      std::vector<Note>& notes) {
  TrackSensor sensor;
  sensor.name = from.name;
  sensor.time_s.resize(recording.samples());
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) sensor.time_s[k] = recording.time.at(k);
  sensor.accel_mps2 = readings_of(recording, from.triad);
  if (command.no_gyro) return sensor;
  const auto channels = find_gyroscope(recording, from.triad);
  if (!channels) return sensor;
  if (command.model != "inertial") {
    notes.push_back({Severity::info,
                     "the gyroscope's channels are left alone: only --model inertial uses them"});
    return sensor;
  }
  sensor.rate_radps = calibrated_rates_radps(recording, *channels, model, sensor.accel_mps2,
                                             command.rate_unit, notes);
  return sensor;
}

TrackSensor prepare(const TrackCommand& command, TrackOptions& options, std::vector<Note>& notes) {
  std::vector<Recording> recordings{
      load_rising(command.file, command.input, progress_bar(command.output))};
  Recording& recording = recordings.front();
  if (recording.time.source == TimeSource::none)
    throw Failure(usage,
                  command.file + ": no time column and no --rate: give --rate HZ or --time NAME");
  const auto models = load_sensors(command.input, notes);
  const std::vector<Accelerometer> found = chosen_accelerometers(command, recordings);
  for (const Accelerometer& one : found)
    drop_unusable(one.triad, command.no_gyro ? std::nullopt : find_gyroscope(recording, one.triad),
                  recording, recording.notes);
  calibrate(models, found, recordings);
  remove_warm_up(command.input, models, found, recordings, notes);
  notes.insert(notes.end(), recording.notes.begin(), recording.notes.end());
  const bool warm = command.input.since_switch_on_s.has_value();
  if (!models.empty()) take_from_sensor(models.front(), warm, options);
  read_lists(command, recording, options);
  read_fixes(command, recording.duration_s(), options, notes);
  TrackSensor sensor =
      sensor_of(command, recording, found.front(), sensor_model_of(models, 0), notes);
  if (found.size() > 1) sensor.name = found.front().triad.name;
  for (std::size_t k = 1; k < found.size(); ++k) {
    estimate::ParallelAccelerometer& beside = sensor.beside.emplace_back();
    beside.name = found[k].triad.name;
    beside.accel_mps2 = readings_of(recording, found[k].triad);
    if (!models.empty()) beside.figures = figures_of(models[models.size() > 1 ? k : 0], warm);
  }
  return sensor;
}

TrackOptions options_of(TrackCommand& command) {
  TrackOptions options;
  read_gravity(command, options);
  using estimate::TrackModel;
  options.only_end_rests = command.rests == "ends";
  options.model = command.model == "pva"     ? TrackModel::pva
                  : command.model == "fused" ? TrackModel::fused
                                             : TrackModel::inertial;
  options.jerk_psd_m2ps5 = command.jerk_psd_m2ps5;
  if (!command.axis.empty()) options.axis = parse_axis(command.axis);
  options.same_place = command.same_place;
  options.same_place_std_m = command.same_place_std_m;
  options.shortest_rest_s = command.shortest_rest_s;
  options.rest_speed_std_mps = command.rest_speed_std_mps;
  options.scale_std = command.scale_std;
  options.take_as_acceleration = command.take_as_acceleration;
  options.progress = progress_bar(command.output);
  return options;
}

// Errors of the estimate name the file.
estimate::TrackSolution solve_track(const std::string& file,
                                    const TrackSensor& sensor,
                                    const TrackOptions& options) {
  auto solution = estimate::estimate_track(sensor, options);
  if (!solution)
    throw Failure(status_of(solution.error(), Stage::computing), solution.error().at(file));
  return std::move(solution).value();
}

void run_track(const TrackCommand& given) {
  TrackCommand command = given;
  expect_sense(command);
  report::TrackReport report;
  report.inputs = {command.file};
  report.options = options_of(command);
  const TrackSensor sensor = prepare(command, report.options, report.notes);
  report.solution = solve_track(command.file, sensor, report.options);
  report.options.progress = {};  // which clears the progress bar
  finish(report::describe(report), [&] { return report::track_series(report); }, command.output);
}

}  // namespace

Verb track_verb() {
  return make_verb<TrackCommand>({.name = "track",
                                  .group = "Estimate",
                                  .help = "displacement from acceleration, from rest to rest"},
                                 add_track_flags, run_track);
}

}  // namespace proofmass::app
