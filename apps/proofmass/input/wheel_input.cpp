#include "input/wheel_input.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <optional>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/encoder_update.hpp"

namespace proofmass::app {
namespace {

constexpr double s_per_ns = 1e-9;

std::optional<std::int64_t> end_ns(const Recording& recording) {
  if (!recording.time.start_ns) return std::nullopt;
  return *recording.time.start_ns + static_cast<std::int64_t>(recording.duration_s() / s_per_ns);
}

// Two recordings share a clock if their time intervals overlap.
bool share_a_clock(const Recording& a, const Recording& b) {
  const auto &a_start = a.time.start_ns, &b_start = b.time.start_ns;
  return a_start && b_start && *a_start <= *end_ns(b) && *b_start <= *end_ns(a);
}

void keep_notes(const std::vector<Recording>& recordings, std::vector<Note>& notes) {
  for (const Recording& recording : recordings) {
    for (const Note& note : recording.notes) {
      const bool several = recordings.size() > 1;
      notes.push_back(note.at(several ? recording.source : ""));
    }
  }
}

// The calibrated errors refer to the encoder's zero, which only an index or an absolute angle
// keeps.
estimate::WheelEncoder wheel_encoder(const Recording& recording,
                                     const EncoderFlags& flags,
                                     const InputFlags& input,
                                     double begin_s,
                                     const sensor::SensorModel* model,
                                     std::vector<Note>& notes) {
  EncoderChannel channel = encoder_of(recording, flags, input, notes);
  for (double& time : channel.fixes.time_s) time += begin_s;
  for (const signal::CountSlip& slip : channel.index_slips)
    notes.push_back({Severity::warning,
                     fmt::format("{}: {:+d} counts between the index pulses at {:.1f} and {:.1f} s "
                                 "that do not belong to whole turns",
                                 channel.name, slip.counts, slip.start_s, slip.end_s)});
  estimate::WheelEncoder out{channel.name, std::move(channel.fixes), channel.step_rad};
  if (model == nullptr) return out;
  const auto errors = sensor::encoder_errors_rad(model->encoder);
  if (errors && (channel.has_index || channel.absolute))
    out.errors_rad = *errors;
  else if (errors)
    notes.push_back({Severity::info,
                     channel.name +
                         ": the encoder's calibration in the sensor file is not used: without an "
                         "index pulse the zero of the count is not that of the calibration",
                     {Advice{"index"}}});
  return out;
}

}  // namespace

estimate::WheelSensor wheel_sensor(const Recording& recording,
                                   const Accelerometer& from,
                                   double begin_s,
                                   const GyroscopeUse& gyroscope,
                                   const sensor::SensorModel* model,
                                   std::vector<Note>& notes) {
  estimate::WheelSensor sensor;
  sensor.name = from.name;
  sensor.time_s.resize(recording.samples());
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k) {
    sensor.time_s[k] = begin_s + recording.time.at(k);
  }
  const Triad& triad = from.triad;
  if (triad.axes() < 2) {
    throw Failure(usage, from.name +
                             ": one axis only: an accelerometer needs two in the plane of the "
                             "wheel");
  }
  // With two axes, a cyclic permutation makes z the missing one and preserves handedness.
  std::array order{triad.x, triad.y, triad.z};
  while (order[2] && triad.axes() == 2) std::rotate(order.begin(), order.begin() + 1, order.end());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (order[axis]) sensor.accel_mps2[axis] = recording.channels[*order[axis]].values.copy();
  }
  if (!gyroscope.wanted || triad.axes() < 3) return sensor;
  if (const auto channels = find_gyroscope(recording, triad);
      channels && channels != gyroscope.taken)
    sensor.rate_radps = calibrated_rates_radps(recording, *channels, model, sensor.accel_mps2,
                                               gyroscope.unit_if_unknown, notes);
  return sensor;
}

namespace {

std::vector<Recording> load_timed(const std::vector<std::string>& files,
                                  const InputFlags& flags,
                                  const OutputFlags& output) {
  std::vector<Recording> recordings;
  for (const std::string& file : files) {
    recordings.push_back(load_even(file, flags, progress_bar(output)));
    if (recordings.back().time.source == TimeSource::none)
      throw Failure(usage, file + ": no time column and no --rate: give --rate HZ or --time NAME");
  }
  return recordings;
}

std::vector<Accelerometer> one_or_two_accelerometers(const std::vector<Recording>& recordings) {
  std::vector<Accelerometer> found = accelerometers(recordings);
  if (found.size() <= 2) return found;
  std::string names;
  for (const Accelerometer& one : found) names += (names.empty() ? "" : ", ") + one.name;
  throw Failure(usage,
                fmt::format("{} accelerometers ({}), expected one or two: choose with --channel",
                            found.size(), names));
}

// Start of each recording: after the first one's, if they share a clock.
std::vector<double> starts_s(const std::vector<Recording>& recordings, bool clocks_shared) {
  std::vector<double> starts(recordings.size(), 0.0);
  if (recordings.size() != 2 || !clocks_shared) return starts;
  const auto &a = recordings[0].time.start_ns, &b = recordings[1].time.start_ns;
  const std::int64_t first = std::min(*a, *b);
  return {static_cast<double>(*a - first) * s_per_ns, static_cast<double>(*b - first) * s_per_ns};
}

}  // namespace

WheelInput wheel_input(const std::vector<std::string>& files,
                       const InputFlags& all_flags,
                       const GyroscopeUse& gyroscope,
                       const EncoderFlags& encoder,
                       const OutputFlags& output) {
  InputFlags flags = all_flags;
  if (encoder.wanted) read_encoder_too(encoder, flags);
  WheelInput input;
  std::vector<Recording> recordings = load_timed(files, flags, output);
  const auto models = load_sensors(flags, input.notes);
  const std::vector<Accelerometer> found = one_or_two_accelerometers(recordings);
  for (const Accelerometer& one : found) {
    Recording& recording = recordings[one.recording];
    drop_unusable(one.triad, gyroscope.wanted ? find_gyroscope(recording, one.triad) : std::nullopt,
                  recording, recording.notes);
  }
  calibrate(models, found, recordings);
  remove_warm_up(flags, models, found, recordings, input.notes);
  keep_notes(recordings, input.notes);
  input.clocks_shared =
      recordings.size() == 1 || share_a_clock(recordings.front(), recordings.back());
  const std::vector<double> begins_s = starts_s(recordings, input.clocks_shared);
  GyroscopeUse use = gyroscope;
  for (const Accelerometer& one : found) {
    const Recording& recording = recordings[one.recording];
    const double begin_s = begins_s[one.recording];
    input.sensors.push_back(wheel_sensor(
        recording, one, begin_s, use, sensor_model_of(models, input.sensors.size()), input.notes));
    if (recordings.size() == 1 && !input.sensors.back().rate_radps[0].empty())
      use.taken = find_gyroscope(recording, one.triad);
    if (encoder.wanted && !input.encoder && one.recording == 0)
      input.encoder = wheel_encoder(recording, encoder, flags, begin_s, sensor_model_of(models, 0),
                                    input.notes);
  }
  if (encoder.wanted && !input.encoder)
    throw Failure(usage, files.front() + ": --encoder: no accelerometer beside the encoder");
  if (!models.empty()) {
    input.alignment_std_rad = sensor::alignment_std_rad(models.front()).value_or(0.0);
    if (const auto& bandwidth = models.front().electrical.bandwidth[0])
      input.bandwidth_hz = bandwidth->value;
  }
  return input;
}

}  // namespace proofmass::app
