#include "input/input.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <utility>

#include "cli/exit_status.hpp"
#include "host.hpp"
#include "proofmass/core/repeated_rows.hpp"
#include "proofmass/io/recording_in_memory.hpp"
#include "proofmass/sensor/calibration.hpp"
#include "proofmass/sensor/gravity.hpp"
#include "proofmass/sensor/warm_up.hpp"
#include "proofmass/signal/even_grid.hpp"

namespace proofmass::app {
namespace {

// One sensor file for all accelerometers, or one for each.
const sensor::SensorModel& model_of(const std::vector<sensor::SensorModel>& models, std::size_t k) {
  return models[models.size() > 1 ? k : 0];
}

// The flag that helps if the accelerometers of a recording are not usable.
std::string flag_hint(const std::vector<sensor::SensorModel>& models, const Recording& recording) {
  const std::vector<Triad> triads = accelerometer_triads(recording);
  if (triads.empty()) return ": name its channels with --channel, their unit with --unit";
  for (const Triad& triad : triads)
    for (const auto& axis : {triad.x, triad.y, triad.z}) {
      if (!axis || !models.empty()) continue;
      const Quantity quantity = recording.channels[*axis].unit.quantity;
      if (quantity == Quantity::acceleration) continue;
      return quantity == Quantity::voltage || quantity == Quantity::counts
                 ? ": give a --sensor file with its sensitivity"
                 : ": give --unit";
    }
  return {};
}

Failure failure_of(const Error& error,
                   const std::vector<sensor::SensorModel>& models,
                   const std::vector<Recording>& recordings) {
  std::string hint;
  for (const Recording& recording : recordings)
    if (hint.empty()) hint = flag_hint(models, recording);
  return {status_of(error, Stage::reading), error.message + hint};
}

std::vector<std::size_t> named_channels(const std::vector<std::string>& names,
                                        const Recording& head) {
  std::vector<std::size_t> channels(names.empty() ? head.channels.size() : 0);
  std::iota(channels.begin(), channels.end(), std::size_t{0});
  for (const std::string& name : names) {
    const Channel* channel = head.find(name);
    if (channel == nullptr) {
      std::string known;
      for (const Channel& other : head.channels) known += (known.empty() ? "" : ", ") + other.name;
      throw Failure(usage, fmt::format("--channel {}: {} has {}", name, head.source, known));
    }
    channels.push_back(static_cast<std::size_t>(channel - head.channels.data()));
  }
  return channels;
}

Result<sensor::SensorFile> sensor_file(const std::string& path, const InputFlags& flags) {
  if (flags.host) {
    const auto given = flags.host->sensor_files.find(path);
    if (given != flags.host->sensor_files.end())
      return sensor::parse_sensor_file(given->second, path);
  }
  return sensor::read_sensor_file(path);
}

// Replaces the supply stated in the files by --supply.
void set_supply(double supply_v,
                std::vector<sensor::SensorModel>& models,
                std::vector<Note>& notes) {
  bool any = false;
  for (sensor::SensorModel& model : models) {
    if (!model.electrical.reference_supply) continue;
    any = true;
    model.electrical.supply = sensor::make_figure(supply_v, "V", "--supply");
    model.electrical.supply_channel.clear();
    const Result<std::string> unit = sensor::reading_unit(model.calibration);
    if (unit && *unit == "counts") {
      notes.push_back({Severity::warning,
                       "--supply: the sensor file's calibration is of counts, which are taken as "
                       "they are at any supply"});
    }
  }
  if (!any) {
    throw Failure(usage,
                  "--supply: no sensor file states the supply of its figures: give "
                  "electrical.reference_supply, which makes it ratiometric");
  }
}

}  // namespace

io::ReadOptions read_options(const InputFlags& flags, const Progress& progress) {
  io::ReadOptions options;
  options.rate_hz = flags.rate_hz;
  if (!flags.unit.empty()) options.unit = parse_unit(flags.unit);
  options.time_channel = flags.time;
  options.channels = flags.channels;
  options.variables = flags.variables;
  if (flags.resample_hz) {
    options.resample = signal::ResampleOptions{*flags.resample_hz,
                                               signal::parse_resample_method(flags.resample_method)
                                                   .value_or(signal::ResampleMethod::sinc)};
  }
  options.skew_s = flags.skew_s.value_or(0.0);
  options.duckdb_library = duckdb_library();
  options.progress = progress;
  return options;
}

std::string duckdb_library() {
  const char* path = std::getenv("PROOFMASS_DUCKDB_LIB");
  return path != nullptr ? path : "";
}

std::optional<Recording> given_recording(const std::string& file, const InputFlags& flags) {
  if (!flags.host) return std::nullopt;
  const auto given = flags.host->recordings.find(file);
  if (given == flags.host->recordings.end()) return std::nullopt;
  Recording taken =
      flags.host->may_be_read_again ? given->second : std::exchange(given->second, {});
  auto recording = io::recording_in_memory(std::move(taken), read_options(flags, {}));
  if (!recording) {
    throw Failure(status_of(recording.error(), Stage::reading), recording.error().at(file));
  }
  return cut_to_window(std::move(recording).value(), flags);
}

Recording load(const std::string& file, const InputFlags& flags, const Progress& progress) {
  if (auto given = given_recording(file, flags)) return without_repeated_rows(std::move(*given));
  return without_repeated_rows(cut_to_window(
      need(io::read_recording(file, read_options(flags, progress)), Stage::reading), flags));
}

Recording load_even(const std::string& file, const InputFlags& flags, const Progress& progress) {
  return signal::without_late_stamps(signal::with_even_stamps(load(file, flags, progress)));
}

Recording load_rising(const std::string& file, const InputFlags& flags, const Progress& progress) {
  return with_rising_time(load_even(file, flags, progress));
}

Recording with_rising_time(const Recording& whole) {
  Recording rising = with_rising_stamps(whole);
  const std::size_t lost = whole.samples() - rising.samples();
  if (lost > 0)
    rising.notes.push_back(
        {Severity::warning, fmt::format("{} that {} the time of the sample before {} left out",
                                        lost == 1 ? "1 sample" : fmt::format("{} samples", lost),
                                        lost == 1 ? "has" : "have", lost == 1 ? "is" : "are")});
  return rising;
}

Recording cut_to_window(Recording recording, const InputFlags& flags) {
  if (!flags.from_s && !flags.to_s) return recording;
  Result<Recording> part =
      cut(recording, flags.from_s.value_or(-std::numeric_limits<double>::infinity()),
          flags.to_s.value_or(std::numeric_limits<double>::infinity()));
  if (!part) {
    throw Failure(status_of(part.error(), Stage::reading), part.error().at(recording.source));
  }
  return std::move(part).value();
}

std::vector<Accelerometer> accelerometers(const std::vector<Recording>& recordings) {
  auto found = sensor::accelerometers(recordings);
  if (!found)
    throw Failure(usage, found.error().message +
                             ": name its channels with --channel, their unit with --unit");
  return std::move(found).value();
}

std::vector<sensor::SensorModel> load_sensors(const InputFlags& flags, std::vector<Note>& notes) {
  std::vector<sensor::SensorModel> models;
  for (const std::string& path : flags.sensors) {
    sensor::SensorFile file = need(sensor_file(path, flags), Stage::reading);
    notes.insert(notes.end(), file.notes.begin(), file.notes.end());
    models.push_back(std::move(file.model));
  }
  if (flags.supply_v) set_supply(*flags.supply_v, models, notes);
  return models;
}

void calibrate(const std::vector<sensor::SensorModel>& models,
               const std::vector<Accelerometer>& found,
               std::vector<Recording>& recordings) {
  const Status done = sensor::apply(models, found, recordings);
  if (!done) throw failure_of(done.error(), models, recordings);
}

sensor::CalibratedBlocks calibrated_blocks(const InputFlags& flags,
                                           const Recording& head,
                                           std::vector<Note>& notes) {
  const std::vector<sensor::SensorModel> models = load_sensors(flags, notes);
  auto blocks = sensor::CalibratedBlocks::make(head, named_channels(flags.channels, head), models);
  if (!blocks) throw failure_of(blocks.error(), models, {head});
  return std::move(blocks).value();
}

std::optional<double> on_at_start_s(const InputFlags& flags) {
  if (!flags.since_switch_on_s) return std::nullopt;
  return *flags.since_switch_on_s + std::max(flags.from_s.value_or(0.0), 0.0);
}

void remove_warm_up(const InputFlags& flags,
                    const std::vector<sensor::SensorModel>& models,
                    const std::vector<Accelerometer>& found,
                    std::vector<Recording>& recordings,
                    std::vector<Note>& notes) {
  const bool any = std::any_of(models.begin(), models.end(), [](const sensor::SensorModel& model) {
    return sensor::has_warm_up(model.drift);
  });
  const std::optional<double> on_s = on_at_start_s(flags);
  if (!on_s) {
    if (!any) return;
    notes.push_back({Severity::warning,
                     "the warm-up in the sensor file is not corrected: give --since-switch-on S, "
                     "the time from power-on to the file's first sample"});
    return;
  }
  if (!any) {
    throw Failure(usage,
                  "--since-switch-on: no warm-up is known: give a --sensor file with a [drift] "
                  "section");
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    const sensor::DriftModel& drift = model_of(models, k).drift;
    if (!sensor::has_warm_up(drift)) {
      notes.push_back({Severity::warning, found[k].name + ": its sensor file has no warm-up"});
      continue;
    }
    const Status done =
        sensor::remove_warm_up(drift, found[k].triad, {*on_s}, recordings[found[k].recording]);
    if (!done) {
      throw Failure(status_of(done.error(), Stage::reading), done.error().at(found[k].name));
    }
  }
}

double gravity_mps2(const InputFlags& flags) {
  if (flags.gravity_mps2) return *flags.gravity_mps2;
  if (!flags.latitude_deg) return standard_gravity_mps2;
  return sensor::gravity_mps2({.latitude_rad = *flags.latitude_deg * rad_per_deg,
                               .height_m = flags.height_m.value_or(0.0)});
}

Uncertain uncertain_gravity_mps2(const InputFlags& flags,
                                 const std::optional<double>& std_mps2,
                                 std::vector<Note>& notes) {
  const double gravity = gravity_mps2(flags);
  if (std_mps2) return {gravity, *std_mps2};
  if (flags.gravity_mps2) return {gravity, 0.0};
  if (flags.latitude_deg) return {gravity, sensor::gravity_anomaly_std_mps2};
  notes.push_back({Severity::warning,
                   "gravity: 9.80665 m/s² assumed; local gravity differs, which makes every "
                   "scale uncertain by 0.15 %; give --gravity, or --latitude and --height"});
  return {gravity, sensor::gravity_std_on_earth_mps2};
}

std::array<double, 3> parse_axis(const std::string& text) {
  const bool minus = text.starts_with('-');
  const std::string letter = text.substr(minus || text.starts_with('+') ? 1 : 0);
  const double sign = minus ? -1.0 : 1.0;
  if (letter == "x") return {sign, 0.0, 0.0};
  if (letter == "y") return {0.0, sign, 0.0};
  if (letter == "z") return {0.0, 0.0, sign};
  std::array<double, 3> axis{};
  const char* from = text.data();
  const char* end = from + text.size();
  bool good = true;
  for (std::size_t k = 0; k < 3 && good; ++k) {
    const auto [stop, error] = std::from_chars(from, end, axis[k]);
    good = error == std::errc() && std::isfinite(axis[k]) &&
           (k == 2 ? stop == end : stop != end && *stop == ',');
    from = stop + 1;
  }
  if (!good || std::hypot(axis[0], axis[1], axis[2]) == 0.0) {
    throw Failure(
        usage,
        "--spin-axis: expected x, y, z, -x, -y, -z or three numbers \"0,0,1\", not '" + text + "'");
  }
  return axis;
}

}  // namespace proofmass::app
