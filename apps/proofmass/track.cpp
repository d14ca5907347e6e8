#include "proofmass/estimate/track.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "console.hpp"
#include "exit_status.hpp"
#include "gyroscope.hpp"
#include "input.hpp"
#include "output.hpp"
#include "proofmass/io/instant_list.hpp"
#include "proofmass/io/interval_list.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/report/track_report.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

using estimate::GravityContent;
using estimate::TrackOptions;
using estimate::TrackSensor;

// A word says whether gravity is in the readings, a number how large it is.
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
  if (command.output.output == "-" && command.output.json == "-")
    throw Failure(usage, "--output - and --json - cannot both have standard output: name a file");
  const bool from_stdin = command.file == "-";
  for (const std::string& list : {command.fixes, command.still, command.turns})
    if (from_stdin && list == "-")
      throw Failure(usage, "-: standard input is the recording: name a file for the list");
}

// A list that does not fit the recording is the list's fault.
void need_inside(const Status& inside, const std::string& file) {
  if (!inside)
    throw Failure(status_of(inside.error(), Stage::reading), inside.error().at(file).message);
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
  if (command.fixes.empty()) return;
  const auto fixes = need(io::read_instants(command.fixes), Stage::reading);
  need_inside(io::check_inside(fixes, recording.duration_s()), command.fixes);
  for (const io::Instant& fix : fixes) {
    if (!fix.position_m)
      throw Failure(bad_input, command.fixes +
                                   ": no column of positions: expected a header such as time (s), "
                                   "position (m), std (m)");
    options.fixes.push_back({fix.time_s, *fix.position_m, fix.std_m.value_or(command.fix_std_m)});
  }
}

// The largest of the three: along which axis the motion goes is not known yet.
std::optional<double> scale_std_of(const sensor::Calibration& calibration) {
  std::optional<double> largest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& scale = calibration.scale[axis];
    if (!scale || scale->si() == 0.0) continue;
    std::optional<double> std = scale->std_si();
    if (calibration.covariance) std = std::sqrt((*calibration.covariance)[3 + axis][3 + axis]);
    if (std) largest = std::max(largest.value_or(0.0), *std / std::abs(scale->si()));
  }
  return largest;
}

void take_from_sensor(const sensor::SensorModel& model, TrackOptions& options) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& white = model.noise.white[axis];
    const auto& walk = model.noise.random_walk[axis];
    if (white && white->si() > 0.0) options.white_mps2_rthz[axis] = white->si();
    if (walk) options.walk_mps2_rts[axis] = std::abs(walk->si());
  }
  if (!options.scale_std) options.scale_std = scale_std_of(model.calibration);
}

Accelerometer only_accelerometer(const std::vector<Recording>& recordings) {
  const std::vector<Accelerometer> found = accelerometers(recordings);
  if (found.size() == 1) return found.front();
  std::string names;
  for (const Accelerometer& one : found) names += (names.empty() ? "" : ", ") + one.triad.name;
  throw Failure(usage,
                fmt::format("{}: {} accelerometers ({}), expected one: choose with --channel",
                            recordings.front().source, found.size(), names));
}

TrackSensor sensor_of(const TrackCommand& command,
                      const Recording& recording,
                      const Accelerometer& from,
                      std::vector<Note>& notes) {
  TrackSensor sensor;
  sensor.name = from.name;
  sensor.time_s.resize(recording.samples());
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) sensor.time_s[k] = recording.time.at(k);
  const std::array axes{from.triad.x, from.triad.y, from.triad.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (axes[axis]) sensor.accel_mps2[axis] = recording.channels[*axes[axis]].values;
  if (command.no_gyro) return sensor;
  if (const auto channels = find_gyroscope(recording, from.triad))
    sensor.rate_radps = rates_radps(recording, *channels, command.rate_unit, notes);
  return sensor;
}

TrackSensor prepare(const TrackCommand& command, TrackOptions& options, std::vector<Note>& notes) {
  std::vector<Recording> recordings{
      load(command.file, command.input, progress_bar(command.output))};
  Recording& recording = recordings.front();
  if (recording.time.source == TimeSource::none)
    throw Failure(usage,
                  command.file + ": no time column and no --rate: give --rate HZ or --time NAME");
  const auto models = load_sensors(command.input, notes);
  const Accelerometer one = only_accelerometer(recordings);
  calibrate(models, {one}, recordings);
  remove_warm_up(command.input, models, {one}, recordings, notes);
  notes.insert(notes.end(), recording.notes.begin(), recording.notes.end());
  if (!models.empty()) take_from_sensor(models.front(), options);
  read_lists(command, recording, options);
  return sensor_of(command, recording, one, notes);
}

TrackOptions options_of(TrackCommand& command) {
  TrackOptions options;
  read_gravity(command, options);
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
estimate::TrackSolution solve(const TrackSensor& sensor, const TrackOptions& options) {
  auto solution = estimate::estimate_track(sensor, options);
  if (!solution)
    throw Failure(status_of(solution.error(), Stage::computing),
                  solution.error().at(sensor.name).message);
  return std::move(solution).value();
}

}  // namespace

void run(const TrackCommand& given) {
  TrackCommand command = given;
  expect_sense(command);
  report::TrackReport report;
  report.inputs = {command.file};
  report.options = options_of(command);
  const TrackSensor sensor = prepare(command, report.options, report.notes);
  report.solution = solve(sensor, report.options);
  report.options.progress = {};  // which wipes the bar away
  show_notes(report.notes, "", command.output);
  show_notes(report.solution.notes, "", command.output);
  if (!command.output.output.empty())
    write_series(report::track_series(report), command.output.output);
  publish({.text = [&] { return report::track_text(report); },
           .json = [&] { return report::track_json(report); },
           .html = [&] { return report::track_html(report); }},
          command.output);
  hold_to_strict(command.output, !report::texts(report.notes, Severity::bad).empty() ||
                                     !report::texts(report.solution.notes, Severity::bad).empty());
}

}  // namespace proofmass::app
