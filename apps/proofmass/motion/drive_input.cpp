#include "motion/drive_input.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/gyroscope.hpp"
#include "input/input.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::app {
namespace {

constexpr double seconds_per_ns = 1e-9;

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Recordings are of one clock if its readings overlap. Stamps that begin at zero are those of the
// file, not of a clock that others share, unless the files have the same number of samples and the
// same duration, as the files of one logger.
class ClockGroups {
 public:
  struct Place {
    int clock = 0;
    double begin_s = 0.0;
  };

  Place place(const Recording& recording) {
    const std::int64_t start = recording.time.start_ns.value_or(0);
    const auto duration =
        static_cast<std::int64_t>(std::llround(recording.duration_s() / seconds_per_ns));
    const Group now{start, start, start + duration, recording.samples()};
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      Group& group = groups_[g];
      if (!group.is_shared_by(now)) continue;
      group.last_ns = std::max(group.last_ns, now.last_ns);
      return {static_cast<int>(g), static_cast<double>(start - group.origin_ns) * seconds_per_ns};
    }
    groups_.push_back(now);
    return {static_cast<int>(groups_.size()) - 1, 0.0};
  }

 private:
  struct Group {
    std::int64_t origin_ns = 0, first_ns = 0, last_ns = 0;
    std::size_t samples = 0;

    [[nodiscard]] bool is_shared_by(const Group& other) const {
      if (origin_ns == 0 || other.origin_ns == 0)
        return origin_ns == other.origin_ns && last_ns == other.last_ns && samples == other.samples;
      return other.first_ns <= last_ns && other.last_ns >= first_ns;
    }
  };
  std::vector<Group> groups_;
};

Recording with_time(const std::string& file, const InputFlags& flags, const OutputFlags& output) {
  Recording recording = load_rising(file, flags, progress_bar(output));
  if (recording.time.source == TimeSource::none)
    throw Failure(usage, file + ": no time column and no --rate: give --rate HZ or --time NAME");
  return recording;
}

void add_notes(const Recording& recording, std::vector<Note>& notes) {
  for (const Note& note : recording.notes) notes.push_back(note.at(recording.source));
}

// The channel of an encoder: an angle, or counts with --counts-per-turn.
const Channel* encoder_channel(const Recording& recording) {
  for (const Channel& channel : recording.channels) {
    const std::string name = small_letters(channel.name);
    const bool named = name.find("encoder") != std::string::npos ||
                       name.find("wheel_angle") != std::string::npos || name == "angle" ||
                       name == "ticks" || name == "counts";
    if (named) return &channel;
  }
  return nullptr;
}

std::vector<double> encoder_rad(const Channel& channel,
                                const std::optional<double>& counts_per_turn,
                                const std::string& file) {
  std::vector<double> angle = channel.values.copy();
  if (channel.unit.quantity == Quantity::angle && !counts_per_turn) {
    for (double& value : angle) value = channel.unit.si(value);
    return angle;
  }
  if (!counts_per_turn)
    throw Failure(usage, fmt::format("{}: {} has no unit of angle: give --counts-per-turn N", file,
                                     channel.name));
  for (double& value : angle) value *= rad_per_turn / *counts_per_turn;
  return angle;
}

estimate::WheelSensor inertial_sensor(std::vector<Recording>& one,
                                      const std::vector<sensor::SensorModel>& models,
                                      double begin_s,
                                      const GyroscopeUse& gyroscope,
                                      std::vector<Note>& notes) {
  const std::vector<Accelerometer> found = accelerometers(one);
  if (found.size() > 1)
    throw Failure(usage, fmt::format("{}: {} accelerometers, expected one: choose with --channel",
                                     one.front().source, found.size()));
  const Triad& triad = found.front().triad;
  drop_unusable(triad, gyroscope.wanted ? find_gyroscope(one.front(), triad) : std::nullopt,
                one.front(), one.front().notes);
  calibrate(models, found, one);
  return wheel_sensor(one.front(), found.front(), begin_s, gyroscope, sensor_model_of(models, 0),
                      notes);
}

// Reads one recording of the vehicle after the other.
class Reader {
 public:
  Reader(const InputFlags& flags,
         const GyroscopeUse& gyroscope,
         const OutputFlags& output,
         DriveInput& input)
      : flags_(flags),
        gyroscope_(gyroscope),
        output_(output),
        input_(input),
        models_(load_sensors(flags, input.notes)) {}

  void add_wheel(const std::string& file, estimate::VehicleSide side, const DriveFiles& files) {
    std::vector<Recording> one{with_time(file, flags_, output_)};
    estimate::DriveWheel wheel;
    wheel.side = side;
    const auto [clock, begin_s] = clocks_.place(one.front());
    wheel.clock = clock;
    const Channel* encoder =
        accelerometer_triads(one.front()).empty() ? encoder_channel(one.front()) : nullptr;
    if (encoder != nullptr) {
      wheel.sensor.name = file;
      for (std::size_t k = 0; k < one.front().samples(); ++k)
        wheel.sensor.time_s.push_back(begin_s + one.front().time.at(k));
      wheel.encoder_rad = encoder_rad(*encoder, files.counts_per_turn, file);
    } else {
      wheel.sensor = inertial_sensor(one, models_, begin_s, gyroscope_, input_.notes);
    }
    if (!files.front.empty())
      wheel.steered = std::ranges::find(files.front, file) != files.front.end();
    add_notes(one.front(), input_.notes);
    input_.begin_s.push_back(begin_s);
    input_.wheels.push_back(std::move(wheel));
  }

  void add_frame(const std::string& file) {
    std::vector<Recording> one{with_time(file, flags_, output_)};
    const auto [clock, begin_s] = clocks_.place(one.front());
    input_.frame = estimate::DriveFrame{
        inertial_sensor(one, models_, begin_s, gyroscope_, input_.notes), clock};
    add_notes(one.front(), input_.notes);
    input_.begin_s.push_back(begin_s);
  }

 private:
  const InputFlags& flags_;
  const GyroscopeUse& gyroscope_;
  const OutputFlags& output_;
  DriveInput& input_;
  std::vector<sensor::SensorModel> models_;
  ClockGroups clocks_;
};

// A channel whose name has a word that begins so: "Lat_GNSS", "Latitude (°)", "lat".
const Channel* channel_of(const Recording& recording, std::string_view begins) {
  for (const Channel& channel : recording.channels) {
    const std::string name = small_letters(channel.name);
    for (std::size_t at = name.find(begins); at != std::string::npos;
         at = name.find(begins, at + 1)) {
      const bool starts = at == 0 || std::isalpha(static_cast<unsigned char>(name[at - 1])) == 0;
      if (starts && !name.substr(at).starts_with("lateral")) return &channel;
    }
  }
  return nullptr;
}

double radians(const Channel& channel, std::size_t k) {
  if (channel.unit.quantity == Quantity::angle) return channel.unit.si(channel.values[k]);
  return channel.values[k] * rad_per_deg;
}

const Channel* accuracy_of(const Recording& recording) {
  for (const Channel& channel : recording.channels) {
    const std::string name = small_letters(channel.name);
    if (name.find("accuracy") != std::string::npos && name.find("vert") == std::string::npos)
      return &channel;
  }
  return nullptr;
}

// Channels of a recording of positions; accuracy and quality are null without them.
struct PositionChannels {
  const Channel *lat, *lon, *accuracy, *quality;
};

std::optional<estimate::GnssFix> fix_at(const Recording& recording,
                                        const PositionChannels& from,
                                        std::size_t k) {
  estimate::GnssFix fix{.time_s = recording.time.at(k),
                        .latitude_rad = radians(*from.lat, k),
                        .longitude_rad = radians(*from.lon, k)};
  const bool valid = std::abs(fix.latitude_rad) <= rad_per_turn / 4.0 &&
                     std::abs(fix.longitude_rad) <= rad_per_turn &&
                     (fix.latitude_rad != 0.0 || fix.longitude_rad != 0.0) &&
                     (from.quality == nullptr || from.quality->values[k] > 0.0);
  if (!valid) return std::nullopt;
  if (from.accuracy != nullptr && from.accuracy->values[k] > 0.0)
    fix.std_m = from.accuracy->unit.quantity == Quantity::length
                    ? from.accuracy->unit.si(from.accuracy->values[k])
                    : from.accuracy->values[k];
  return fix;
}

// Fixes of valid rows; a fix that repeats the previous row's is the same fix.
estimate::GnssFixes position_fixes(const std::string& file,
                                   const InputFlags& flags,
                                   const OutputFlags& output,
                                   std::vector<Note>& notes) {
  InputFlags own;
  own.host = flags.host;
  const Recording recording = with_time(file, own, output);
  const PositionChannels from{channel_of(recording, "lat"), channel_of(recording, "lon"),
                              accuracy_of(recording), recording.find("quality")};
  if (from.lat == nullptr || from.lon == nullptr)
    throw Failure(usage, file + ": no channels of latitude and longitude (lat…, lon…)");
  estimate::GnssFixes fixes{.name = file, .fixes = {}};
  std::size_t invalid = 0, repeated = 0;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const std::optional<estimate::GnssFix> fix = fix_at(recording, from, k);
    if (!fix)
      ++invalid;
    else if (!fixes.fixes.empty() && fix->latitude_rad == fixes.fixes.back().latitude_rad &&
             fix->longitude_rad == fixes.fixes.back().longitude_rad)
      ++repeated;
    else
      fixes.fixes.push_back(*fix);
  }
  if (fixes.fixes.size() < 5)
    throw Failure(bad_input, fmt::format("{}: {} position fixes, expected at least 5", file,
                                         fixes.fixes.size()));
  notes.push_back({Severity::info, fmt::format("{}: {} position fixes, {} rows that repeat one, {} "
                                               "rows without",
                                               file, fixes.fixes.size(), repeated, invalid)});
  return fixes;
}

}  // namespace

DriveInput drive_input(const DriveFiles& files,
                       const InputFlags& flags,
                       const GyroscopeUse& gyroscope,
                       const OutputFlags& output) {
  const std::size_t count = files.right.size() + files.left.size();
  if (count == 0) throw Failure(usage, "no wheel: give --right FILE or --left FILE, or both");
  if (count > estimate::most_drive_wheels)
    throw Failure(usage, fmt::format("{} wheels, expected four at most", count));
  for (const std::string& file : files.front)
    if (std::ranges::find(files.right, file) == files.right.end() &&
        std::ranges::find(files.left, file) == files.left.end())
      throw Failure(usage, fmt::format("--front {}: expected a file of --right or --left", file));
  std::vector<std::string> wheels = files.right;
  wheels.insert(wheels.end(), files.left.begin(), files.left.end());
  std::ranges::sort(wheels);
  if (const auto twice = std::ranges::adjacent_find(wheels); twice != wheels.end())
    throw Failure(usage, *twice + ": is given twice, as the recording of two wheels");
  DriveInput input;
  Reader reader(flags, gyroscope, output, input);
  for (const std::string& file : files.right)
    reader.add_wheel(file, estimate::VehicleSide::right, files);
  for (const std::string& file : files.left)
    reader.add_wheel(file, estimate::VehicleSide::left, files);
  if (!files.frame.empty()) reader.add_frame(files.frame);
  if (!files.gnss.empty()) {
    input.fixes = position_fixes(files.gnss, flags, output, input.notes);
    input.begin_s.push_back(0.0);
  }
  return input;
}

}  // namespace proofmass::app
