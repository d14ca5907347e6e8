#include "rest_channels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "console.hpp"
#include "exit_status.hpp"
#include "input.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/counter.hpp"
#include "proofmass/signal/even_grid.hpp"

namespace proofmass::app {
namespace {

// One file on its way.
struct Source {
  Recording recording;
  std::vector<std::size_t> chosen;               // channels to analyse
  std::vector<std::optional<std::size_t>> axes;  // of each of them, where known
  std::optional<std::size_t> temperature;
  std::vector<signal::ChannelAudit> audits;  // of the chosen, as recorded
  signal::EvenGrid grid;
};

Recording load_rest(const std::string& file, const RestOptions& options) {
  InputFlags flags = options.input;
  if (!flags.channels.empty() && !options.temperature.empty()) {
    flags.channels.push_back(options.temperature);
  }
  Recording recording = load(file, flags, progress_bar(options.output));
  if (recording.time.source == TimeSource::none) {
    throw Failure(usage, file + ": no time column and no --rate: give --rate HZ or --time NAME");
  }
  return recording;
}

std::size_t place_of(const Recording& recording, const std::string& name) {
  const Channel* channel = recording.find(name);
  if (channel == nullptr) {
    throw Failure(usage, recording.source + ": --temperature: no channel '" + name + "'");
  }
  return static_cast<std::size_t>(channel - recording.channels.data());
}

bool has_samples(const Channel& channel) {
  return std::ranges::any_of(channel.values, [](double x) { return std::isfinite(x); });
}

// The only channel that holds temperatures, unless it is all there is.
std::optional<std::size_t> only_temperature(const Recording& recording, std::vector<Note>& notes) {
  const std::vector<Channel>& channels = recording.channels;
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const bool holds = channels[k].unit.quantity == Quantity::temperature;
    if (holds && has_samples(channels[k])) found.push_back(k);
  }
  if (found.size() > 1) {
    notes.push_back(
        {Severity::warning, fmt::format("{}: {} and {} both hold temperatures: neither "
                                        "is looked at unless --temperature names it",
                                        report::file_name(recording.source),
                                        channels[found[0]].name, channels[found[1]].name)});
  }
  return found.size() == 1 && channels.size() > 1 ? std::optional(found[0]) : std::nullopt;
}

std::optional<std::size_t> temperature_in(const Recording& recording,
                                          const RestOptions& options,
                                          std::vector<Note>& notes) {
  if (!options.temperature.empty()) return place_of(recording, options.temperature);
  return options.find_temperature ? only_temperature(recording, notes) : std::nullopt;
}

std::vector<std::size_t> axes_in(const Recording& recording) {
  std::vector<std::size_t> axes;
  for (const Triad& triad : accelerometer_triads(recording)) {
    for (const auto& axis : {triad.x, triad.y, triad.z}) {
      if (axis) axes.push_back(*axis);
    }
  }
  std::ranges::sort(axes);
  return axes;
}

// All accelerations; else the voltages or counts that look like axes; else all that is no counter.
// Of channels that were named, all.
std::vector<std::size_t> choose(const Source& source, bool named) {
  const std::vector<Channel>& channels = source.recording.channels;
  std::vector<std::size_t> all(channels.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::erase_if(all, [&](std::size_t k) { return k == source.temperature; });
  if (named) return all;
  std::vector<std::size_t> accelerations = all;
  std::erase_if(accelerations,
                [&](std::size_t k) { return channels[k].unit.quantity != Quantity::acceleration; });
  if (!accelerations.empty()) return accelerations;
  if (std::vector<std::size_t> axes = axes_in(source.recording); !axes.empty()) return axes;
  const auto counter = signal::find_counter(source.recording);
  std::erase_if(all, [&](std::size_t k) { return k == counter; });
  return all;
}

std::vector<std::optional<std::size_t>> axes_of(const Source& source) {
  std::vector<std::optional<std::size_t>> axes(source.chosen.size());
  const std::vector<Triad> triads = accelerometer_triads(source.recording);
  if (triads.size() != 1) return axes;
  const std::array places{triads[0].x, triads[0].y, triads[0].z};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (places[axis] == source.chosen[k]) axes[k] = axis;
    }
  }
  return axes;
}

// What is wrong with the chosen channels and their stamps, before any of it is scaled.
void audit(Source& source, const std::string& prefix, std::vector<Note>& notes) {
  Recording part{source.recording.source, source.recording.format, {}, {}, {}, 0};
  std::swap(part.time, source.recording.time);
  std::swap(part.notes, source.recording.notes);
  part.first_line = source.recording.first_line;
  for (const std::size_t k : source.chosen) {
    part.channels.push_back(std::move(source.recording.channels[k]));
  }
  signal::RecordingAudit found = signal::audit(part);
  for (std::size_t k = 0; k < source.chosen.size(); ++k) {
    source.recording.channels[source.chosen[k]] = std::move(part.channels[k]);
  }
  std::swap(part.time, source.recording.time);
  for (const Note& note : found.notes) notes.push_back({note.severity, prefix + note.text});
  source.audits = std::move(found.channels);
}

void lay_out(Source& source, const std::string& prefix, std::vector<Note>& notes) {
  const Recording& recording = source.recording;
  Result<signal::EvenGrid> grid = signal::even_grid(recording.time, recording.samples());
  if (!grid) {
    const Error error = grid.error().at(recording.source);
    throw Failure(status_of(error, Stage::reading), error.message);
  }
  source.grid = std::move(grid).value();
  if (source.grid.missing > 0) {
    notes.push_back(
        {Severity::warning, fmt::format("{}{} missing by the stamps, in {}: left blank", prefix,
                                        report::count_words(source.grid.missing, "sample"),
                                        report::count_words(source.grid.holes.size(), "place"))});
  }
  constexpr double much = 0.1;
  if (source.grid.relative_jitter > much) {
    notes.push_back(
        {Severity::warning,
         fmt::format("{}the stamps jitter by {} % of a step: the samples are taken to be even, {} "
                     "Hz",
                     prefix, report::significant(100.0 * source.grid.relative_jitter, 2),
                     report::compact(source.grid.rate_hz, 6))});
  }
}

// The unit that values of a kind are brought to; none where they are left as recorded.
std::optional<Unit> si_unit(Quantity quantity) {
  constexpr std::array<std::pair<Quantity, const char*>, 8> symbols{
      {{Quantity::acceleration, "m/s^2"},
       {Quantity::angular_rate, "rad/s"},
       {Quantity::angle, "rad"},
       {Quantity::voltage, "V"},
       {Quantity::speed, "m/s"},
       {Quantity::length, "m"},
       {Quantity::time, "s"},
       {Quantity::temperature, "K"}}};
  for (const auto& [known, symbol] : symbols) {
    if (quantity == known) return parse_unit(symbol);
  }
  return std::nullopt;
}

void bring_to_si(Channel& channel) {
  const std::optional<Unit> si = si_unit(channel.unit.quantity);
  if (!si || channel.unit == *si) return;
  for (double& value : channel.values) value = channel.unit.si(value);
  channel.unit = *si;
}

// Of the rate that a series in this unit is the integral of.
Unit rate_unit(const Unit& unit) {
  if (unit.symbol == "m/s") return *parse_unit("m/s^2");
  if (unit.symbol == "rad") return *parse_unit("rad/s");
  if (unit.symbol == "s" || unit.symbol == "1") return {Quantity::unknown, 1.0, 0.0, "1"};
  return {Quantity::unknown, 1.0, 0.0, unit.symbol + "/s"};
}

// Many samples at the rails: their noise is cut off.
std::string clipping(const signal::ChannelAudit& audit, std::size_t samples) {
  constexpr std::size_t fewest = 3;
  constexpr double share = 1e-4;
  const auto clipped = static_cast<double>(audit.clipped);
  if (audit.clipped < fewest || clipped <= share * static_cast<double>(samples)) return {};
  return fmt::format(
      "{} of {} stand at the rails ({} or {} {}): what is cut off there is not in the figures",
      report::grouped(audit.clipped), report::count_words(samples, "sample"),
      report::significant(audit.moments.min, 5), report::significant(audit.moments.max, 5),
      audit.unit.symbol);
}

RestChannel prepared(Source& source, std::size_t k, bool is_phase) {
  Channel& channel = source.recording.channels[source.chosen[k]];
  const signal::ChannelAudit& audit = source.audits[k];
  RestChannel out;
  out.name = channel.name;
  out.rate_hz = source.grid.rate_hz;
  out.axis = source.axes[k];
  out.refused = clipping(audit, channel.values.size());
  const bool calibrated = channel.unit != audit.unit;
  bring_to_si(channel);
  out.unit = channel.unit;
  if (channel.unit.symbol.empty()) out.unit = {Quantity::unknown, 1.0, 0.0, "1"};
  if (is_phase) out.unit = rate_unit(out.unit);
  if (!out.refused.empty()) return out;
  if (audit.lsb && !is_phase) {
    // A sensor file may have scaled it: the step grew as the spread did.
    const double before = audit.moments.std(), after = moments(channel.values).std();
    const double scale = !calibrated ? audit.unit.to_si : before > 0.0 ? after / before : 0.0;
    if (scale > 0.0) out.lsb = *audit.lsb * scale;
  }
  out.series = signal::on_even_grid(channel.values, source.grid);
  std::vector<double>().swap(channel.values);
  return out;
}

RestTemperature prepared_temperature(Source& source) {
  Channel& channel = source.recording.channels[*source.temperature];
  bring_to_si(channel);
  return {channel.name, channel.unit, signal::on_even_grid(channel.values, source.grid)};
}

void calibrate_chosen(Source& source, const InputFlags& flags, std::vector<Note>& notes) {
  const std::vector<sensor::SensorModel> models = load_sensors(flags, notes);
  if (models.empty()) return;
  std::vector<Recording> one;
  one.push_back(std::move(source.recording));
  calibrate(models, accelerometers(one), one);
  source.recording = std::move(one.front());
}

void expect_axes(const RestRecording& recording) {
  for (const RestChannel& channel : recording.channels) {
    if (channel.axis && channel.unit.symbol == "m/s^2") continue;
    throw Failure(usage, fmt::format("--update-sensor: {} is no x, y or z axis of one "
                                     "accelerometer, in m/s^2: choose with --channel, say --unit",
                                     channel.title));
  }
}

RestRecording rest_recording(const std::string& file,
                             const RestOptions& options,
                             std::vector<Note>& notes) {
  RestRecording out;
  const std::string prefix = options.files.size() > 1 ? report::file_name(file) + ": " : "";
  Source source;
  source.recording = load_rest(file, options);
  source.temperature = temperature_in(source.recording, options, notes);
  source.chosen = choose(source, !options.input.channels.empty());
  if (source.chosen.empty()) throw Failure(usage, file + ": no channel to analyse");
  source.axes = axes_of(source);
  audit(source, prefix, notes);
  calibrate_chosen(source, options.input, notes);
  lay_out(source, prefix, notes);
  for (std::size_t k = 0; k < source.chosen.size(); ++k) {
    RestChannel channel = prepared(source, k, options.is_phase);
    channel.title = prefix + channel.name;
    channel.file = file;
    out.channels.push_back(std::move(channel));
  }
  if (source.temperature) out.temperature = prepared_temperature(source);
  return out;
}

}  // namespace

std::vector<RestRecording> rest_recordings(const RestOptions& options, std::vector<Note>& notes) {
  if (options.for_sensor_file && options.files.size() > 1) {
    throw Failure(usage, "--update-sensor: a sensor file takes the figures of one recording");
  }
  std::vector<RestRecording> recordings;
  for (const std::string& file : options.files) {
    recordings.push_back(rest_recording(file, options, notes));
    if (options.for_sensor_file) expect_axes(recordings.back());
  }
  return recordings;
}

}  // namespace proofmass::app
