#include "proofmass/calibrate/rotation.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "proofmass/report/rotation_report.hpp"
#include "proofmass/signal/unusable.hpp"
#include "tumble/modes.hpp"

namespace proofmass::app {
namespace {

std::vector<Recording> load_recordings(const TumbleCommand& command) {
  InputFlags input = command.input;
  if (!input.channels.empty() && !command.angle_channel.empty()) {
    input.channels.push_back(command.angle_channel);
  }
  std::vector<Recording> recordings;
  for (const std::string& file : command.files) {
    recordings.push_back(load_rising(file, input, progress_bar(command.output)));
    if (recordings.back().time.source == TimeSource::none) {
      throw Failure(usage, file + ": no time column and no --rate: give --rate HZ or --time NAME");
    }
  }
  return recordings;
}

std::vector<std::size_t> named_channels(const Recording& recording, const TumbleCommand& command) {
  std::vector<std::size_t> chosen;
  for (const std::string& name : command.input.channels) {
    const auto found = std::ranges::find(recording.channels, name, &Channel::name);
    chosen.push_back(static_cast<std::size_t>(found - recording.channels.begin()));
  }
  if (chosen.size() > 2) {
    throw Failure(usage, fmt::format("--channel: {} channels, expected the one or two in "
                                     "the plane of the wheel",
                                     chosen.size()));
  }
  return chosen;
}

// The channels in the plane of the wheel: the named ones, or those of the only accelerometer
// through which gravity rotates.
std::vector<std::size_t> plane_channels(const Recording& recording, const TumbleCommand& command) {
  if (!command.input.channels.empty()) return named_channels(recording, command);
  const std::vector<Accelerometer> found = accelerometers({recording});
  if (found.size() > 1) {
    std::string names;
    for (const Accelerometer& one : found) names += (names.empty() ? "" : ", ") + one.triad.name;
    throw Failure(usage, fmt::format("{}: {} accelerometers ({}): choose one's axes with --channel",
                                     recording.source, found.size(), names));
  }
  std::vector<std::size_t> channels;
  std::vector<View<double>> readings;
  for (const auto& axis : {found[0].triad.x, found[0].triad.y, found[0].triad.z}) {
    if (!axis) continue;
    channels.push_back(*axis);
    readings.emplace_back(recording.channels[*axis].values);
  }
  std::vector<std::size_t> chosen;
  for (const std::size_t at : calibrate::axes_in_plane(readings)) chosen.push_back(channels[at]);
  return chosen;
}

void drop_saturated(const TumbleCommand& command, std::vector<Recording>& recordings) {
  for (Recording& recording : recordings) {
    const std::vector<Note> found =
        signal::drop_saturated(plane_channels(recording, command), recording);
    recording.notes.insert(recording.notes.end(), found.begin(), found.end());
  }
}

void bring_to_si(Channel& channel) {
  const Unit from = channel.unit;
  const bool volts = from.quantity == Quantity::voltage;
  if (!volts && from.quantity != Quantity::acceleration) return;
  for (double& value : channel.values.edit()) value = from.si(value);
  channel.unit = *parse_unit(volts ? "V" : "m/s^2");
}

// Volts and accelerations in SI, counts unchanged; all of one quantity.
std::string bring_to_one_unit(std::vector<Recording>& recordings,
                              const std::vector<std::vector<std::size_t>>& chosen) {
  std::optional<std::string> unit;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    for (const std::size_t c : chosen[r]) {
      Channel& channel = recordings[r].channels[c];
      bring_to_si(channel);
      const std::string& now = channel.unit.symbol;
      if (unit && *unit != now) {
        throw Failure(usage, fmt::format("{}: channel {} is in {}, another in {}",
                                         recordings[r].source, channel.name, now, *unit));
      }
      unit = now;
    }
  }
  return unit.value_or("");
}

std::vector<double> encoder_angle(const Recording& recording, const std::string& name) {
  if (name.empty()) return {};
  const Channel* channel = recording.find(name);
  if (channel == nullptr) {
    throw Failure(usage, fmt::format("{}: --angle: no channel {}", recording.source, name));
  }
  if (channel->unit.quantity != Quantity::angle) {
    throw Failure(usage, fmt::format("{}: channel {}: expected an angle: write its unit in the "
                                     "header, \"{} (deg)\"",
                                     recording.source, name, name));
  }
  std::vector<double> angle = channel->values.copy();
  for (double& a : angle) a = channel->unit.si(a);
  return angle;
}

calibrate::RotationRecording rotation_recording(const Recording& recording,
                                                const std::vector<std::size_t>& chosen,
                                                const std::string& angle_channel) {
  calibrate::RotationRecording turning;
  turning.name = recording.source;
  turning.time_s.reserve(recording.samples());
  turning.axes.reserve(chosen.size());
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    turning.time_s.push_back(recording.time.at(k));
  }
  for (const std::size_t c : chosen) turning.axes.push_back(recording.channels[c].values.copy());
  turning.angle_rad = encoder_angle(recording, angle_channel);
  return turning;
}

void keep_notes(const std::vector<Recording>& recordings, std::vector<Note>& notes) {
  for (const Recording& recording : recordings) {
    const bool several = recordings.size() > 1;
    for (const Note& note : recording.notes) {
      notes.push_back(note.at(several ? recording.source : ""));
    }
  }
}

}  // namespace

void run_rotation(const TumbleCommand& command) {
  if (!command.update_sensor.empty()) {
    throw Failure(usage,
                  "--update-sensor does not go with --rotating: the axes outside "
                  "the plane of the wheel are unknown");
  }
  if (command.bandwidth_hz && command.angle_channel.empty()) {
    throw Failure(usage,
                  "--bandwidth: without --angle there is no reference for the "
                  "delay");
  }
  report::RotationReport report;
  report.inputs = command.files;
  std::vector<Recording> recordings = load_recordings(command);
  drop_saturated(command, recordings);
  const auto models = load_sensors(command.input, report.notes);
  if (!models.empty()) {
    const std::vector<Accelerometer> found = accelerometers(recordings);
    calibrate(models, found, recordings);
    remove_warm_up(command.input, models, found, recordings, report.notes);
  }
  keep_notes(recordings, report.notes);
  std::vector<std::vector<std::size_t>> chosen;
  chosen.reserve(recordings.size());
  for (const Recording& recording : recordings) {
    chosen.push_back(plane_channels(recording, command));
  }
  report.unit = bring_to_one_unit(recordings, chosen);
  std::vector<calibrate::RotationRecording> turning;
  turning.reserve(recordings.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    turning.push_back(rotation_recording(recordings[r], chosen[r], command.angle_channel));
  }
  for (const std::size_t c : chosen.front()) {
    report.axis_names.push_back(recordings.front().channels[c].name);
  }
  const Uncertain gravity =
      uncertain_gravity_mps2(command.input, command.gravity_std_mps2, report.notes);
  report.gravity_mps2 = gravity.value;
  report.fit =
      need(calibrate::fit_rotation(turning, {.gravity_mps2 = report.gravity_mps2,
                                             .gravity_std_mps2 = gravity.std,
                                             .readings_are_accelerations = report.unit == "m/s^2",
                                             .bandwidth_hz = command.bandwidth_hz.value_or(0.0)}),
           Stage::computing);
  for (const std::string& text : report.fit.doubts) {
    report.notes.push_back({Severity::bad, text});
  }
  for (const std::string& text : report.fit.notes) {
    report.notes.push_back({Severity::warning, text});
  }
  finish(report::describe(report), {}, command.output);
}

}  // namespace proofmass::app
