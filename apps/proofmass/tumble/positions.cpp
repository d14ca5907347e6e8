#include "tumble/positions.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/input.hpp"
#include "input/listed_rests.hpp"
#include "input/saturated_rests.hpp"
#include "proofmass/calibrate/tumble/dwells.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/rests.hpp"
#include "tumble/columns.hpp"
#include "tumble/table.hpp"

namespace proofmass::app {
namespace {

using calibrate::Dwell;
using calibrate::TumblePosition;

// Reads the whole table: --channel would omit the angle.
Recording load_all(const std::string& file, const TumbleCommand& command) {
  InputFlags flags = command.input;
  flags.channels.clear();
  return load(file, flags, progress_bar(command.output));
}

void apply_sensors(Recording& recording, const TumbleCommand& command, std::vector<Note>& notes) {
  const std::vector<sensor::SensorModel> models = load_sensors(command.input, notes);
  if (models.empty()) return;
  std::vector<Recording> one;
  one.push_back(std::move(recording));
  calibrate(models, accelerometers(one), one);
  recording = std::move(one.front());
}

std::string times_of(const Recording& recording, const std::vector<Dwell>& dwells) {
  std::string text;
  constexpr std::size_t most = 12;
  for (std::size_t k = 0; k < dwells.size() && k < most; ++k)
    text += fmt::format("{}{}–{} s", k > 0 ? ", " : "",
                        report::fixed(recording.time.at(dwells[k].first), 1),
                        report::fixed(recording.time.at(dwells[k].last), 1));
  return dwells.size() > most ? text + ", …" : text;
}

signal::RestSearch search_rests(const Recording& recording,
                                const TumbleColumns& columns,
                                const TumbleCommand& command) {
  constexpr std::size_t most_axes = 3;
  std::vector<View<double>> axes;
  for (const std::size_t k : columns.outputs)
    if (axes.size() < most_axes) axes.push_back(recording.channels[k].values);
  return signal::find_rests(
      axes, {.rate_hz = recording.time.rate_hz, .shortest_s = command.shortest_rest_s});
}

std::vector<Dwell> rests_of(const Recording& recording,
                            const TumbleColumns& columns,
                            const TumbleCommand& command) {
  const signal::RestSearch found = search_rests(recording, columns, command);
  if (found.rests.empty())
    throw Failure(bad_input, fmt::format("{}: no rest found: {}", recording.source,
                                         found.why_none.empty() ? "the sensor was never at rest"
                                                                : found.why_none));
  std::vector<Dwell> dwells;
  dwells.reserve(found.rests.size());
  for (const signal::Rest& rest : found.rests)
    dwells.push_back({.first = rest.first, .last = rest.last});
  return dwells;
}

// Intervals in which both the recorded angle and the sensor are constant.
std::vector<Dwell> steady_rests(const Recording& recording,
                                const TumbleColumns& columns,
                                const TumbleCommand& command,
                                View<double> angle_rad) {
  const std::vector<Dwell> steady = calibrate::steady_angles(
      angle_rad, {.rate_hz = recording.time.rate_hz, .shortest_s = command.shortest_rest_s});
  const signal::RestSearch found = search_rests(recording, columns, command);
  return found.rests.empty() ? steady : calibrate::at_rest(steady, found.rests);
}

// What precedes a file's rests, and whether some are left out.
struct FilePlace {
  std::size_t rests_before = 0;
  bool saturated = false;  // an output is at the limits of its range
};

// --angles: one per rest, in order over all files.
std::vector<double> given_angles(const Recording& recording,
                                 const std::vector<Dwell>& dwells,
                                 const TumbleCommand& command,
                                 const FilePlace& place) {
  const std::vector<double>& angles = command.angles_deg;
  const bool last = recording.source == command.files.back();
  const std::size_t before = place.rests_before, end = before + dwells.size();
  if (end > angles.size() || (last && end != angles.size()))
    throw Failure(
        usage, fmt::format(
                   "{}: {} found, at {}: --angles has {} for {}: give one angle "
                   "for each rest, or --rest S to find only longer ones{}",
                   recording.source, report::count_words(dwells.size(), "rest"),
                   times_of(recording, dwells),
                   report::count_words(angles.size() - std::min(before, angles.size()), "angle"),
                   before > 0 ? "the rests from here on" : "them",
                   place.saturated ? "; rests at the limits of the range are not among them" : ""));
  std::vector<double> out;
  for (std::size_t k = before; k < end; ++k) out.push_back(angles[k] * rad_per_deg);
  return out;
}

double mean_temperature(const Recording& recording,
                        const TumbleColumns& columns,
                        const Dwell& dwell) {
  const Channel& channel = recording.channels[*columns.temperature];
  double sum = 0.0;
  for (std::size_t k = dwell.first; k <= dwell.last; ++k) sum += channel.values[k];
  const double mean = sum / static_cast<double>(dwell.last - dwell.first + 1);
  return channel.unit.quantity == Quantity::temperature ? channel.unit.si(mean) : mean;
}

// Static intervals, and the angles of the table.
struct Settings {
  std::vector<Dwell> dwells;
  std::vector<double> angles_rad;
};

// --rests: with their angles, if the list has one for each.
Settings listed_settings(const Recording& recording, const TumbleCommand& command) {
  Settings out;
  for (ListedRest& rest : listed_rests(recording, command.rests)) {
    if (rest.angle_rad) out.angles_rad.push_back(*rest.angle_rad);
    out.dwells.push_back(std::move(rest.dwell));
  }
  if (out.angles_rad.size() == out.dwells.size() || out.angles_rad.empty()) return out;
  throw Failure(bad_input, fmt::format("{}: {} rests and {} angles: expected one for each or none",
                                       command.rests, out.dwells.size(), out.angles_rad.size()));
}

Settings settings_of(const Recording& recording,
                     const TumbleColumns& columns,
                     const TumbleCommand& command,
                     const FilePlace& place) {
  Settings out;
  if (!command.rests.empty()) out = listed_settings(recording, command);
  if (!command.angles_deg.empty()) {
    if (out.dwells.empty()) out.dwells = rests_of(recording, columns, command);
    out.angles_rad = given_angles(recording, out.dwells, command, place);
  }
  if (!out.angles_rad.empty()) return out;
  if (!columns.angle)
    throw Failure(usage, command.rests + ": no column angle, and " + recording.source +
                             " has none: give one angle for each rest with --angles");
  const std::vector<double> angle = angles_rad(recording.channels[*columns.angle]);
  if (out.dwells.empty()) out.dwells = steady_rests(recording, columns, command, angle);
  out.angles_rad = calibrate::dwell_angles(angle, out.dwells);
  return out;
}

// Without the rests in which an output is at the limits of its range.
void erase_saturated(const Recording& recording, const TumbleColumns& columns, Settings& settings) {
  Settings kept;
  for (std::size_t k = 0; k < settings.dwells.size(); ++k) {
    if (!is_measured(recording, columns.outputs, settings.dwells[k])) continue;
    kept.dwells.push_back(settings.dwells[k]);
    kept.angles_rad.push_back(settings.angles_rad[k]);
  }
  settings = std::move(kept);
}

TumblePart read_rests(const Recording& recording,
                      const TumbleColumns& columns,
                      const TumbleCommand& command,
                      const FilePlace& place) {
  TumblePart part;
  Settings settings = settings_of(recording, columns, command, place);
  part.rests = settings.dwells.size();
  if (place.saturated) erase_saturated(recording, columns, settings);
  const auto& [dwells, angles] = settings;
  if (dwells.size() < 2)
    throw Failure(bad_input,
                  fmt::format("{}: the table's angle is constant in {}: expected two or more",
                              recording.source, report::count_words(dwells.size(), "place")));
  const bool timed = recording.time.source != TimeSource::none;
  for (std::size_t k = 0; k < dwells.size(); ++k) {
    const double begin = recording.time.at(dwells[k].first);
    TumblePosition p;
    p.angle_rad = angles[k];
    if (timed) p.time_s = 0.5 * (begin + recording.time.at(dwells[k].last));
    if (columns.temperature) p.temperature = mean_temperature(recording, columns, dwells[k]);
    p.label = timed ? fmt::format("rest at {} s", report::fixed(begin, 1))
                    : fmt::format("rest {}", k + 1);
    part.readings.positions.push_back(std::move(p));
  }
  const signal::RecordingAudit audit = signal::audit(recording);
  for (const std::size_t k : columns.outputs) {
    const Channel& channel = recording.channels[k];
    TumbleOutput out = make_output(recording, k, command.input);
    const double factor = to_si(channel, command.input);
    const auto means =
        calibrate::dwell_outputs(channel.values, dwells, audit.channels[k].lsb.value_or(0.0));
    if (!means)
      throw Failure(status_of(means.error(), Stage::reading),
                    means.error().at(channel.name).at(recording.source));
    for (std::size_t j = 0; j < dwells.size(); ++j) {
      out.values.push_back(means->mean[j] * factor);
      out.std.push_back(means->std[j] * factor);
    }
    out.noise_dof = means->noise_dof;
    part.readings.outputs.push_back(std::move(out));
  }
  return part;
}

void place(TumblePart& part, const TumbleCommand& command, std::size_t file) {
  const auto of_file = [&](const std::vector<int>& given, const char* flag) -> std::optional<int> {
    if (given.empty()) return std::nullopt;
    if (given.size() != 1 && given.size() != command.files.size())
      throw Failure(
          usage, fmt::format("{}: {} for {}: give one for all or one for each", flag, given.size(),
                             report::count_words(command.files.size(), "file")));
    return given[given.size() > 1 ? file : 0];
  };
  const std::optional<int> plane = of_file(command.planes, "--plane");
  const std::optional<int> mount = of_file(command.mounts, "--mount");
  for (TumblePosition& p : part.readings.positions) {
    if (plane) p.plane = *plane;
    if (mount) p.mount_rad = *mount * rad_per_deg;
    if (command.files.size() > 1) {
      p.label = report::file_name(command.files[file]) + ", " + p.label;
      p.time_s.reset();  // the clocks of different files are unrelated
    }
  }
}

TumblePart read_part(const TumbleCommand& command,
                     std::size_t file,
                     std::size_t before,
                     std::vector<Note>& notes) {
  Recording recording = load_all(command.files[file], command);
  recording.source = command.files[file];
  const auto columns_now = [&] {
    return tumble_columns(recording, command.angle_channel, command.input.channels);
  };
  const bool saturated = drop_saturated_rests(columns_now().outputs, recording);
  apply_sensors(recording, command, notes);
  const TumbleColumns columns = columns_now();
  for (const Note& note : recording.notes) {
    // A table of positions needs no time base.
    if (note.severity != Severity::info && note.text.find("no time column") == std::string::npos)
      notes.push_back(note);
  }
  if (!command.angles_deg.empty() || !command.rests.empty())
    return read_rests(recording, columns, command, {before, saturated});
  if (!columns.angle)
    throw Failure(usage, recording.source +
                             ": no column with the table's angle: name it with --angle, or give "
                             "--angles for the rests of a recording");
  if (calibrate::stops_in_places(angles_rad(recording.channels[*columns.angle]),
                                 recording.time.rate_hz))
    return read_rests(recording, columns, command, {before, saturated});
  return read_table(recording, columns, command.input, notes);
}

// Appends the positions of a further file.
void append(TumbleReadings more, const std::string& file, TumbleReadings& all) {
  all.positions.insert(all.positions.end(), more.positions.begin(), more.positions.end());
  for (TumbleOutput& out : all.outputs) {
    const auto same = std::find_if(more.outputs.begin(), more.outputs.end(),
                                   [&](const TumbleOutput& o) { return o.name == out.name; });
    if (same == more.outputs.end() || same->unit != out.unit)
      throw Failure(usage,
                    fmt::format("{}: expected a channel {} in {}, as in the first file", file,
                                out.name, out.unit.symbol.empty() ? "no unit" : out.unit.symbol));
    out.values.insert(out.values.end(), same->values.begin(), same->values.end());
    out.std.insert(out.std.end(), same->std.begin(), same->std.end());
    if (same->noise_dof > 0.0)
      out.noise_dof =
          out.noise_dof > 0.0 ? std::min(out.noise_dof, same->noise_dof) : same->noise_dof;
  }
}

}  // namespace

TumbleReadings tumble_readings(const TumbleCommand& command, std::vector<Note>& notes) {
  TumbleReadings all;
  std::size_t rests = 0;
  for (std::size_t file = 0; file < command.files.size(); ++file) {
    TumblePart part = read_part(command, file, rests, notes);
    place(part, command, file);
    rests += part.rests;
    if (file == 0)
      all = std::move(part.readings);
    else
      append(std::move(part.readings), command.files[file], all);
  }
  const std::string count = std::to_string(all.positions.size());
  all.source = rests == 0               ? "a table of " + count + " positions"
               : !command.rests.empty() ? count + " listed rests of a recording"
               : command.angles_deg.empty()
                   ? count + " intervals in which the recorded angle is constant"
                   : count + " rests of a recording, their angles given";
  return all;
}

}  // namespace proofmass::app
