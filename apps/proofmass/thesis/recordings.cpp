#include "thesis/recordings.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "cli/exit_status.hpp"
#include "input/input.hpp"
#include "input/rest_channels.hpp"
#include "input/wheel_input.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/warm_up.hpp"
#include "tumble/positions.hpp"

namespace proofmass::app {
namespace {

// Several recordings share the list, so each note is prefixed with its file.
void keep_notes(const std::string& file, const std::vector<Note>& more, std::vector<Note>& notes) {
  const std::string name = report::file_name(file);
  for (const Note& note : more) {
    const bool named = note.text.find(name) != std::string::npos;
    notes.push_back(note.at(named ? "" : name));
  }
}

thesis::StaticAxis still_axis(RestChannel channel, std::vector<Note>& notes) {
  const bool unknown = channel.unit.symbol.empty();
  if (!channel.refused.empty())
    notes.push_back(
        {Severity::warning, fmt::format("{}: left out: {}", channel.name, channel.refused)});
  else if (channel.unit.symbol != "m/s^2")
    throw Failure(
        usage,
        fmt::format("{}: channel {}: expected an acceleration, but it is in {}: give {}",
                    channel.file, channel.name, unknown ? "no known unit" : channel.unit.symbol,
                    unknown ? "--unit" : "a --sensor file with its sensitivity"));
  return {channel.name, std::move(channel.series).take()};
}

thesis::StaticRecord still_record(const ThesisCommand& command, std::vector<Note>& notes) {
  InputFlags flags = command.input;
  flags.since_switch_on_s = flags.since_switch_on_s.value_or(0.0);
  std::vector<Note> own;
  std::vector<RestRecording> recordings = rest_recordings(
      {.files = {command.still}, .input = flags, .output = command.output, .temperature = ""}, own);
  double rate_hz = 0.0;
  std::vector<thesis::StaticAxis> axes;
  for (RestChannel& channel : recordings.front().channels) {
    rate_hz = channel.rate_hz;
    axes.push_back(still_axis(std::move(channel), own));
  }
  std::erase_if(axes, [](const thesis::StaticAxis& axis) { return axis.accel_mps2.empty(); });
  keep_notes(command.still, std::move(own), notes);
  if (axes.empty()) throw Failure(bad_input, command.still + ": no channel that can be analysed");
  return thesis::static_record(command.still, rate_hz, *on_at_start_s(flags), std::move(axes));
}

thesis::TumbleRecord tumble_record(const ThesisCommand& command, std::vector<Note>& notes) {
  TumbleCommand tumble;
  tumble.files = {command.tumble};
  tumble.angles_deg = command.angles_deg;
  tumble.input = command.input;
  tumble.output = command.output;
  std::vector<Note> own;
  TumbleReadings readings = tumble_readings(tumble, own);
  keep_notes(command.tumble, std::move(own), notes);
  thesis::TumbleRecord record;
  record.source = command.tumble;
  record.positions = std::move(readings.positions);
  for (TumbleOutput& output : readings.outputs)
    record.channels.push_back({output.name, output.unit, std::move(output.values),
                               std::move(output.std), output.noise_dof});
  return record;
}

// --since-switch-on applies to the wheel only if a sensor file has a warm-up.
InputFlags wheel_flags(const ThesisCommand& command) {
  InputFlags flags = command.input;
  std::vector<Note> of_the_sensor_files;  // reported by wheel_input()
  const auto models = load_sensors(flags, of_the_sensor_files);
  const auto knows = [](const sensor::SensorModel& model) {
    return sensor::has_warm_up(model.drift);
  };
  if (std::ranges::none_of(models, knows)) flags.since_switch_on_s.reset();
  return flags;
}

thesis::WheelRecord wheel_record(const std::string& file,
                                 const ThesisCommand& command,
                                 std::vector<Note>& notes) {
  WheelInput input =
      wheel_input({file}, wheel_flags(command), {.wanted = false}, {}, command.output);
  keep_notes(file, std::move(input.notes), notes);
  thesis::WheelRecord record;
  record.source = file;
  record.sensors = std::move(input.sensors);
  record.clocks_shared = input.clocks_shared;
  record.radius_m = command.radius_m;
  return record;
}

}  // namespace

thesis::OwnRecordings own_recordings(const ThesisCommand& command, std::vector<Note>& notes) {
  thesis::OwnRecordings own;
  if (!command.still.empty()) own.still = still_record(command, notes);
  if (!command.tumble.empty()) own.tumble = tumble_record(command, notes);
  for (const std::string& file : command.wheels)
    own.wheel.push_back(wheel_record(file, command, notes));
  return own;
}

}  // namespace proofmass::app
