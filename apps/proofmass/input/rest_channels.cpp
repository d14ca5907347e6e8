#include "input/rest_channels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "input/block_reader.hpp"
#include "input/channel_selection.hpp"
#include "input/input.hpp"
#include "proofmass/core/repeated_rows.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/rests.hpp"
#include "proofmass/signal/unusable.hpp"

namespace proofmass::app {
namespace {

// State of one file.
struct Source {
  Recording recording;
  std::vector<std::size_t> chosen;               // channels to analyse
  std::vector<std::optional<std::size_t>> axes;  // of each channel, if known
  std::optional<std::size_t> temperature;
  std::vector<signal::ChannelAudit> audits;  // of the chosen channels, as recorded
  signal::EvenGrid grid;
};

void expect_time(const Recording& recording) {
  if (recording.time.source != TimeSource::none) return;
  throw Failure(usage,
                recording.source + ": no time column and no --rate: give --rate HZ or --time NAME");
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

// The only temperature channel, unless it is the only channel.
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

// Notes on the chosen channels and their stamps, before scaling.
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
    throw Failure(status_of(error, Stage::reading), error);
  }
  source.grid = std::move(grid).value();
  note_grid(source.grid, source.grid.holes.size(), prefix, notes);
}

void to_si(Channel& channel) {
  const Unit si = si_unit(channel.unit);
  if (channel.unit == si) return;
  for (double& value : channel.values.edit()) value = channel.unit.si(value);
  channel.unit = si;
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
  to_si(channel);
  out.unit = series_unit(channel.unit, is_phase);
  if (!out.refused.empty()) return out;
  if (audit.lsb && !is_phase) {
    // A sensor file may have scaled the channel; the quantisation step scales with the spread.
    const double before = audit.moments.std(), after = moments(channel.values).std();
    const double scale = !calibrated ? audit.unit.to_si : before > 0.0 ? after / before : 0.0;
    if (scale > 0.0) out.lsb = *audit.lsb * scale;
  }
  out.series = signal::on_even_grid(std::move(channel.values), source.grid);
  return out;
}

RestTemperature prepared_temperature(Source& source) {
  Channel& channel = source.recording.channels[*source.temperature];
  to_si(channel);
  return {channel.name, channel.unit, signal::on_even_grid(std::move(channel.values), source.grid)};
}

void calibrate_chosen(Source& source, const InputFlags& flags, std::vector<Note>& notes) {
  const std::vector<sensor::SensorModel> models = load_sensors(flags, notes);
  if (models.empty()) return;
  std::vector<Recording> one;
  one.push_back(std::move(source.recording));
  calibrate(models, accelerometers(one), one);
  source.recording = std::move(one.front());
}

bool is_of_motion(Quantity quantity) {
  return quantity == Quantity::acceleration || quantity == Quantity::angular_rate ||
         quantity == Quantity::voltage || quantity == Quantity::counts;
}

bool shows_motion(const RestChannel& channel) {
  return !channel.series.empty() && is_of_motion(channel.unit.quantity);
}

// The values that a sensor or its logger repeats are missing. The channels are analysed one by one,
// and so is their noise, which shows that a value is repeated.
void drop_stuck(Source& source, const std::string& prefix, std::vector<Note>& notes) {
  std::vector<std::vector<std::size_t>> one_by_one;
  for (const std::size_t k : source.chosen)
    if (is_of_motion(source.recording.channels[k].unit.quantity)) one_by_one.push_back({k});
  for (const Note& note : signal::drop_stuck(one_by_one, source.recording))
    notes.push_back({note.severity, prefix + note.text});
}

// The same quantity of the same file.
bool moves_with(const RestChannel& channel, const RestChannel& other) {
  return channel.file == other.file && channel.unit.quantity == other.unit.quantity;
}

report::RestShare share_of(const signal::RestSearch& search,
                           std::size_t samples,
                           double rate_hz,
                           double start_s) {
  report::RestShare found;
  std::size_t resting = 0, longest = 0;
  for (const signal::Rest& rest : search.rests) {
    const std::size_t length = rest.last - rest.first + 1;
    resting += length;
    if (length <= longest) continue;
    longest = length;
    found.longest_start_s = start_s + static_cast<double>(rest.first) / rate_hz;
    found.longest_end_s = start_s + static_cast<double>(rest.last) / rate_hz;
  }
  found.share = static_cast<double>(resting) / static_cast<double>(samples);
  return found;
}

// The next channels, from k on, that move together: up to three axes of one sensor.
std::vector<RestChannel*> moving_group(const std::vector<RestChannel*>& channels, std::size_t& k) {
  constexpr std::size_t most_axes = 3;
  // fewer samples do not determine the noise at rest
  constexpr std::size_t fewest_samples = 500;
  std::vector<RestChannel*> group;
  for (; k < channels.size() && group.size() < most_axes; ++k) {
    RestChannel& channel = *channels[k];
    if (!shows_motion(channel) || channel.series.size() < fewest_samples) continue;
    if (!group.empty() && !moves_with(channel, *group.front())) break;
    group.push_back(&channel);
  }
  return group;
}

}  // namespace

double first_used_s(const InputFlags& input) {
  return std::max(0.0, input.from_s.value_or(0.0));
}

std::vector<RestChannel*> pointers_to(std::vector<RestChannel>& channels) {
  std::vector<RestChannel*> all;
  all.reserve(channels.size());
  for (RestChannel& channel : channels) all.push_back(&channel);
  return all;
}

void find_share_at_rest(double start_s, const std::vector<RestChannel*>& channels) {
  for (std::size_t k = 0; k < channels.size();) {
    const std::vector<RestChannel*> group = moving_group(channels, k);
    if (group.empty()) continue;
    std::vector<View<double>> axes;
    for (const RestChannel* channel : group) axes.emplace_back(channel->series);
    const double rate_hz = group.front()->rate_hz;
    const signal::RestSearch search = signal::find_rests(axes, {.rate_hz = rate_hz});
    if (search.window == 0) continue;
    for (RestChannel* channel : group)
      channel->rest = share_of(search, axes.front().size(), rate_hz, start_s);
  }
}

void expect_axis(const RestChannel& channel, const RestOptions& options) {
  if (channel.axis && channel.unit.symbol == "m/s^2") return;
  if (channel.axis && channel.unit.symbol == "rad/s" && options.rates_for_sensor_file) return;
  throw Failure(usage, fmt::format("--update-sensor: {} is not an x, y or z axis of one "
                                   "accelerometer, in m/s^2: choose with --channel, give --unit",
                                   channel.title));
}

std::string file_prefix(const std::string& file, const RestOptions& options) {
  return options.files.size() > 1 ? report::file_name(file) + ": " : "";
}

std::variant<Recording, io::RecordingStream> open_rest(const std::string& file,
                                                       const RestOptions& options) {
  if (options.for_sensor_file && options.files.size() > 1) {
    throw Failure(usage, "--update-sensor: a sensor file takes the figures of one recording");
  }
  InputFlags flags = options.input;
  if (!flags.channels.empty() && !options.temperature.empty()) {
    flags.channels.push_back(options.temperature);
  }
  auto opened = open_input(file, flags, progress_bar(options.output));
  const auto* recording = std::get_if<Recording>(&opened);
  expect_time(recording != nullptr ? *recording : std::get<io::RecordingStream>(opened).head());
  return opened;
}

RestRecording rest_recording(Recording recording,
                             const RestOptions& options,
                             std::vector<Note>& notes) {
  RestRecording out;
  const std::string file = recording.source;
  const std::string prefix = file_prefix(file, options);
  out.start_ns = recording.time.start_ns;
  Source source;
  source.recording = without_repeated_rows(std::move(recording));
  source.temperature = temperature_in(source.recording, options, notes);
  RestChoice choice =
      choose_rest(source.recording, source.temperature, !options.input.channels.empty());
  source.chosen = std::move(choice.channels);
  source.axes = std::move(choice.axes);
  if (source.chosen.empty()) throw Failure(usage, file + ": no channel to analyse");
  audit(source, prefix, notes);
  if (!options.is_phase) drop_stuck(source, prefix, notes);
  calibrate_chosen(source, options.input, notes);
  lay_out(source, prefix, notes);
  for (std::size_t k = 0; k < source.chosen.size(); ++k) {
    RestChannel channel = prepared(source, k, options.is_phase);
    channel.title = prefix + channel.name;
    channel.file = file;
    if (options.for_sensor_file) expect_axis(channel, options);
    out.channels.push_back(std::move(channel));
  }
  if (!options.is_phase && !options.leave_rest)
    find_share_at_rest(first_used_s(options.input), pointers_to(out.channels));
  if (source.temperature) out.temperature = prepared_temperature(source);
  return out;
}

std::vector<RestRecording> rest_recordings(const RestOptions& options, std::vector<Note>& notes) {
  RestOptions whole = options;
  whole.input.memory_mb = std::numeric_limits<double>::infinity();
  std::vector<RestRecording> recordings;
  for (const std::string& file : options.files) {
    recordings.push_back(
        rest_recording(std::get<Recording>(open_rest(file, whole)), options, notes));
  }
  return recordings;
}

}  // namespace proofmass::app
