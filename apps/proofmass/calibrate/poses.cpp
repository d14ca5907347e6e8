#include "calibrate/poses.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "calibrate/gyroscope.hpp"
#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/input.hpp"
#include "input/listed_rests.hpp"
#include "input/saturated_rests.hpp"
#include "proofmass/calibrate/recording_poses.hpp"
#include "proofmass/io/positions/direction_label.hpp"
#include "proofmass/io/positions/pose_table.hpp"
#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::app {
namespace {

using calibrate::Dwell;
using calibrate::Pose;
using report::PoseFile;
using report::PoseOrigin;

// Poses of one file.
struct FilePoses {
  PoseFile file;
  std::vector<Pose> poses;
  std::string sensor;
  Unit unit;
  std::optional<double> reference_supply_v;
  double noise_dof = 0.0;
  std::array<double, 3> sample_std{};
  std::optional<calibrate::RestSession> session;
  std::optional<RateSession> rates;
};

std::optional<Eigen::Vector3d> vector_of(const std::optional<std::array<double, 3>>& up) {
  if (!up) return std::nullopt;
  return Eigen::Vector3d(up->data());
}

// With advice for a recording of positions.
Failure failure_of(const Error& error, const std::string& file) {
  Error shown = error.at(file);
  if (error.code == Errc::invalid_argument) shown.advice = {Advice{"channel"}, Advice{"unit"}};
  if (error.code != Errc::not_observable) return {status_of(error, Stage::reading), shown};
  shown.advice = {Advice{"rests"}};
  return {bad_input, shown};
}

template <class T>
T need_of_file(Result<T> result, const std::string& file) {
  if (!result) throw failure_of(result.error(), file);
  return std::move(result).value();
}

FilePoses table_poses(const Recording& recording,
                      const InputFlags& flags,
                      std::vector<Note>& notes) {
  const std::string& file = recording.source;
  std::optional<Unit> unit;
  if (!flags.unit.empty()) unit = parse_unit(flags.unit);
  const io::PoseTable table = need(io::pose_table(recording, unit), Stage::reading);
  notes.insert(notes.end(), table.notes.begin(), table.notes.end());
  FilePoses out;
  out.file = {.file = file, .origin = PoseOrigin::table, .poses = table.rows.size()};
  if (table.rows.empty()) return out;
  const Unit& given = table.rows.front().unit;
  out.unit = need_of_file(calibrate::pose_unit(given), file);
  bool known = true;
  for (const io::PoseRow& row : table.rows) {
    Pose& pose = out.poses.emplace_back();
    pose.label = row.label;
    pose.start_s = row.start_s;
    pose.end_s = row.end_s;
    pose.samples = row.samples.value_or(0);
    pose.up = vector_of(row.up);
    if (!pose.up) pose.up = vector_of(io::direction_of_label(row.label));
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      pose.mean(k) = given.si(row.mean[axis]);
      if (!row.std_of_mean) continue;
      const double std = given.to_si * (*row.std_of_mean)[axis];
      pose.mean_covariance(k, k) = std * std;
    }
    known &= row.std_of_mean.has_value();
    if (pose.samples > 1) out.noise_dof += static_cast<double>(pose.samples - 1);
  }
  // A standard deviation stated by the user without degrees of freedom is taken as exact.
  if (known && out.noise_dof == 0.0) out.noise_dof = 1e6;
  if (!known) out.noise_dof = 0.0;
  return out;
}

std::vector<Dwell> listed(const Recording& recording, const std::string& list) {
  std::vector<Dwell> rests;
  for (ListedRest& rest : listed_rests(recording, list)) {
    if (!rest.dwell.up) rest.dwell.up = vector_of(io::direction_of_label(rest.dwell.label));
    rests.push_back(std::move(rest.dwell));
  }
  return rests;
}

// If labels name positions, the intervals so labelled are rests; other labels are listed in a note.
std::vector<Dwell> labelled(const Recording& recording, std::vector<Note>& notes) {
  std::vector<Dwell> rests;
  std::string others;
  for (const Label& label : recording.labels) {
    const auto up = io::direction_of_label(label.text);
    if (up)
      rests.push_back({label.first, label.last, label.text, vector_of(up)});
    else
      others += (others.empty() ? "" : ", ") + label.text;
  }
  if (rests.empty()) return rests;
  notes.push_back({Severity::info, fmt::format("{}: rests are those that column {} names positions",
                                               recording.source, recording.label_channel)});
  if (!others.empty()) {
    notes.push_back({Severity::info, fmt::format("{}: left out, being no positions: {}",
                                                 recording.source, others)});
  }
  return rests;
}

struct Rests {
  std::vector<Dwell> dwells;  // empty: to be detected
  PoseOrigin origin = PoseOrigin::found;
};

Rests rests_of(const Recording& recording,
               const CalibrateCommand& command,
               std::vector<Note>& notes) {
  if (!command.rests.empty()) return {listed(recording, command.rests), PoseOrigin::listed};
  std::vector<Dwell> named = labelled(recording, notes);
  if (!named.empty()) return {std::move(named), PoseOrigin::labelled};
  return {};
}

// If the sensor file to be written names a channel for the supply, the voltages are scaled to the
// reference supply.
std::optional<double> bring_to_reference_supply(const std::string& sensor_file,
                                                Recording& recording) {
  if (sensor_file.empty() || !std::filesystem::exists(sensor_file)) return std::nullopt;
  const sensor::SensorFile file = need(sensor::read_sensor_file(sensor_file), Stage::reading);
  const sensor::Electrical& electrical = file.model.electrical;
  if (electrical.supply_channel.empty() || !electrical.reference_supply) return std::nullopt;
  const Triad triad = need_of_file(calibrate::only_accelerometer(recording), recording.source);
  const bool volts = recording.channels[*triad.x].unit.quantity == Quantity::voltage;
  if (!volts) return std::nullopt;
  const Status done = sensor::bring_to_reference_supply(electrical, triad, recording);
  if (!done) throw Failure(bad_input, done.error().at(recording.source));
  return electrical.reference_supply->si();
}

FilePoses recording_poses(Recording recording,
                          const CalibrateCommand& command,
                          std::vector<Note>& notes) {
  const Triad triad = need_of_file(calibrate::only_accelerometer(recording), recording.source);
  const std::vector<std::size_t> axes{*triad.x, *triad.y, *triad.z};
  const bool saturated = drop_saturated_rests(axes, recording);
  std::vector<Recording> one;
  one.push_back(std::move(recording));
  if (!command.input.sensors.empty()) {
    const auto models = load_sensors(command.input, notes);
    calibrate(models, accelerometers(one), one);
  }
  Recording& read = one.front();
  notes.insert(notes.end(), read.notes.begin(), read.notes.end());
  FilePoses out;
  if (command.supplies_v.empty())
    out.reference_supply_v = bring_to_reference_supply(command.update_sensor, read);
  Rests rests = rests_of(read, command, notes);
  if (saturated)
    std::erase_if(rests.dwells,
                  [&](const Dwell& dwell) { return !is_measured(read, axes, dwell); });
  calibrate::RecordingPoses found =
      need_of_file(calibrate::recording_poses(
                       read, {.dwells = rests.dwells, .shortest_s = command.shortest_rest_s}),
                   read.source);
  if (command.gyro) out.rates = rate_session(read, found, command, notes);
  calibrate::PoseMeans& means = found.means;
  out.unit = found.unit;
  out.poses = std::move(means.poses);
  out.noise_dof = means.noise_dof;
  out.sample_std = means.sample_std;
  out.session = std::move(means.session);
  out.sensor = found.triad.name;
  out.file = {.file = read.source,
              .origin = rests.origin,
              .poses = out.poses.size(),
              .samples = read.samples(),
              .duration_s = read.time.rate_hz > 0.0 ? read.duration_s() : 0.0,
              .times_known = read.time.rate_hz > 0.0,
              .rejected = means.rejected};
  return out;
}

FilePoses poses_of(const std::string& file,
                   const CalibrateCommand& command,
                   std::vector<Note>& notes) {
  Recording recording = load_even(file, command.input, progress_bar(command.output));
  const bool means = command.means || io::looks_like_pose_table(recording) ||
                     (command.rests.empty() && io::is_plain_pose_table(recording));
  if (means) return table_poses(recording, command.input, notes);
  return recording_poses(std::move(recording), command, notes);
}

// Adds one file's positions to those of the files before it.
void append(FilePoses one, PoseSet& out) {
  if (!out.files.empty() && one.unit.symbol != out.unit.symbol)
    throw Failure(usage,
                  fmt::format("{} is in {}, {} in {}: calibrate them apart", out.files.front().file,
                              out.unit.symbol, one.file.file, one.unit.symbol));
  out.noise_dof = out.files.empty() ? one.noise_dof : std::min(out.noise_dof, one.noise_dof);
  out.unit = one.unit;
  out.reference_supply_v = one.reference_supply_v;
  out.sensor = one.sensor;
  for (std::size_t k = 0; k < 3; ++k)
    out.sample_std[k] = std::max(out.sample_std[k], one.sample_std[k]);
  out.pose_file.insert(out.pose_file.end(), one.poses.size(), out.files.size());
  out.poses.insert(out.poses.end(), one.poses.begin(), one.poses.end());
  if (one.rates) {
    one.rates->file = out.files.size();
    if (!out.rates.empty() && out.rates.front().unit.symbol != one.rates->unit.symbol)
      throw Failure(usage, "--gyro: the gyroscopes of the files are in different units");
    out.rates.push_back(std::move(*one.rates));
  }
  out.files.push_back(std::move(one.file));
  if (one.session) out.sessions.push_back(std::move(*one.session));
}

}  // namespace

PoseSet read_poses(const std::vector<std::string>& files,
                   const CalibrateCommand& command,
                   std::vector<Note>& notes) {
  PoseSet out;
  for (const std::string& file : files) {
    std::vector<Note> own;
    FilePoses one = poses_of(file, command, own);
    for (Note& note : own) {
      if (files.size() > 1) note = note.at(file);
      notes.push_back(std::move(note));
    }
    append(std::move(one), out);
  }
  return out;
}

}  // namespace proofmass::app
