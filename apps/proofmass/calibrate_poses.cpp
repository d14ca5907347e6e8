#include "calibrate_poses.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "listed_rests.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/io/direction_label.hpp"
#include "proofmass/io/pose_table.hpp"
#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "proofmass/signal/channel_audit.hpp"
#include "proofmass/signal/rests.hpp"

namespace proofmass::app {
namespace {

using calibrate::Dwell;
using calibrate::Pose;
using report::PoseFile;
using report::PoseOrigin;

// What one file gives.
struct FilePoses {
  PoseFile file;
  std::vector<Pose> poses;
  std::string sensor;
  Unit unit;
  std::optional<double> reference_supply_v;
  double noise_dof = 0.0;
  std::array<double, 3> sample_std{};
  std::optional<calibrate::RestSession> session;
};

std::optional<Eigen::Vector3d> vector_of(const std::optional<std::array<double, 3>>& up) {
  if (!up) return std::nullopt;
  return Eigen::Vector3d(up->data());
}

// The unit in which the poses of a unit are kept.
Unit si_of(const Unit& unit, const std::string& file) {
  switch (unit.quantity) {
    case Quantity::acceleration:
      return *parse_unit("m/s^2");
    case Quantity::voltage:
      return *parse_unit("V");
    case Quantity::counts:
      return unit;
    default:
      throw Failure(usage, fmt::format("{}: the readings are in {}: expected an acceleration, a "
                                       "voltage or counts: give --unit",
                                       file, unit.symbol.empty() ? "no known unit" : unit.symbol));
  }
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
  out.unit = si_of(given, file);
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
  // A standard deviation that the user states without its basis is taken for exact.
  if (known && out.noise_dof == 0.0) out.noise_dof = 1e6;
  if (!known) out.noise_dof = 0.0;
  return out;
}

// The three channels of the only accelerometer.
Triad triad_of(const Recording& recording) {
  const std::vector<Triad> triads = accelerometer_triads(recording);
  std::string names;
  for (const Triad& triad : triads) names += (names.empty() ? "" : ", ") + triad.name;
  if (triads.size() == 1 && triads.front().axes() == 3) return triads.front();
  if (triads.size() > 1) {
    throw Failure(usage, fmt::format("{}: {} accelerometers ({}), expected one: choose its three "
                                     "channels with --channel",
                                     recording.source, triads.size(), names));
  }
  throw Failure(usage, recording.source +
                           ": no accelerometer with three axes found: name its channels x, y and "
                           "z, or choose them with --channel");
}

std::vector<Dwell> listed(const Recording& recording, const std::string& list) {
  std::vector<Dwell> rests;
  for (ListedRest& rest : listed_rests(recording, list)) {
    if (!rest.dwell.up) rest.dwell.up = vector_of(io::direction_of_label(rest.dwell.label));
    rests.push_back(std::move(rest.dwell));
  }
  return rests;
}

// Where labels name positions, those that do are rests, and the others are told.
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

std::vector<Dwell> found(const Recording& recording,
                         const std::array<View<double>, 3>& axes,
                         const CalibrateCommand& command) {
  const signal::RestSearch search = signal::find_rests(
      axes, {.rate_hz = recording.time.rate_hz, .shortest_s = command.shortest_rest_s});
  if (search.rests.empty()) {
    throw Failure(bad_input, fmt::format("{}: no rest found: {}; give them with --rests FILE",
                                         recording.source, search.why_none));
  }
  std::vector<Dwell> rests;
  rests.reserve(search.rests.size());
  for (const signal::Rest& rest : search.rests) rests.push_back({rest.first, rest.last});
  return rests;
}

struct Rests {
  std::vector<Dwell> dwells;
  PoseOrigin origin;
};

Rests rests_of(const Recording& recording,
               const std::array<View<double>, 3>& axes,
               const CalibrateCommand& command,
               std::vector<Note>& notes) {
  if (!command.rests.empty()) return {listed(recording, command.rests), PoseOrigin::listed};
  std::vector<Dwell> named = labelled(recording, notes);
  if (!named.empty()) return {std::move(named), PoseOrigin::labelled};
  return {found(recording, axes, command), PoseOrigin::found};
}

void set_times(const Recording& recording, const std::vector<Dwell>& rests, FilePoses& out) {
  for (std::size_t k = 0; k < rests.size(); ++k) {
    out.poses[k].start_s = recording.time.at(rests[k].first);
    out.poses[k].end_s = recording.time.at(rests[k].last);
  }
}

// Where the sensor file to be written says that a channel holds the supply, the voltages are those
// that the reference supply would have given.
std::optional<double> bring_to_reference_supply(const std::string& sensor_file,
                                                const Triad& triad,
                                                Recording& recording) {
  if (sensor_file.empty() || !std::filesystem::exists(sensor_file)) return std::nullopt;
  const sensor::SensorFile file = need(sensor::read_sensor_file(sensor_file), Stage::reading);
  const sensor::Electrical& electrical = file.model.electrical;
  if (electrical.supply_channel.empty() || !electrical.reference_supply) return std::nullopt;
  const bool volts = recording.channels[*triad.x].unit.quantity == Quantity::voltage;
  if (!volts) return std::nullopt;
  const Status done = sensor::bring_to_reference_supply(electrical, triad, recording);
  if (!done) throw Failure(bad_input, done.error().at(recording.source).message);
  return electrical.reference_supply->si();
}

FilePoses recording_poses(Recording recording,
                          const CalibrateCommand& command,
                          std::vector<Note>& notes) {
  std::vector<Recording> one;
  one.push_back(std::move(recording));
  if (!command.input.sensors.empty()) {
    const auto models = load_sensors(command.input, notes);
    calibrate(models, accelerometers(one), one);
  }
  Recording& read = one.front();
  notes.insert(notes.end(), read.notes.begin(), read.notes.end());
  const Triad triad = triad_of(read);
  std::array<View<double>, 3> axes;
  std::array<double, 3> lsb{};
  FilePoses out;
  if (command.supplies_v.empty())
    out.reference_supply_v = bring_to_reference_supply(command.update_sensor, triad, read);
  std::size_t k = 0;
  for (const auto& index : {triad.x, triad.y, triad.z}) {
    Channel& channel = read.channels[*index];
    const Unit si = si_of(channel.unit, read.source);
    if (k > 0 && si.symbol != out.unit.symbol)
      throw Failure(usage, read.source + ": the three axes are in different units: give --unit");
    out.unit = si;
    if (channel.unit.quantity != Quantity::counts)
      for (double& value : channel.values) value = channel.unit.si(value);
    axes[k] = channel.values;
    lsb[k] = signal::find_lsb(axes[k]).value_or(0.0);
    ++k;
  }
  const Rests rests = rests_of(read, axes, command, notes);
  calibrate::PoseMeans means = need(
      [&] {
        auto result = calibrate::pose_means(axes, rests.dwells, lsb);
        return result ? result : Result<calibrate::PoseMeans>(result.error().at(read.source));
      }(),
      Stage::reading);
  out.poses = std::move(means.poses);
  out.noise_dof = means.noise_dof;
  out.sample_std = means.sample_std;
  out.session = std::move(means.session);
  out.sensor = triad.name;
  set_times(read, rests.dwells, out);
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
  Recording recording = load(file, command.input, progress_bar(command.output));
  const bool means = command.means || io::looks_like_pose_table(recording) ||
                     (command.rests.empty() && io::is_plain_pose_table(recording));
  if (means) return table_poses(recording, command.input, notes);
  return recording_poses(std::move(recording), command, notes);
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
      if (files.size() > 1) note.text = file + ": " + note.text;
      notes.push_back(std::move(note));
    }
    if (!out.files.empty() && one.unit.symbol != out.unit.symbol) {
      throw Failure(
          usage, fmt::format("{} is in {}, {} in {}: calibrate them apart", out.files.front().file,
                             out.unit.symbol, file, one.unit.symbol));
    }
    out.noise_dof = out.files.empty() ? one.noise_dof : std::min(out.noise_dof, one.noise_dof);
    out.unit = one.unit;
    out.reference_supply_v = one.reference_supply_v;
    out.sensor = one.sensor;
    for (std::size_t k = 0; k < 3; ++k)
      out.sample_std[k] = std::max(out.sample_std[k], one.sample_std[k]);
    out.pose_file.insert(out.pose_file.end(), one.poses.size(), out.files.size());
    out.poses.insert(out.poses.end(), one.poses.begin(), one.poses.end());
    out.files.push_back(std::move(one.file));
    if (one.session) out.sessions.push_back(std::move(*one.session));
  }
  return out;
}

}  // namespace proofmass::app
