#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/rest_channels.hpp"
#include "noise/command.hpp"
#include "noise/joined.hpp"
#include "noise/options.hpp"
#include "noise/streaming.hpp"
#include "noise/sums.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/report/noise/report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/noise_update.hpp"
#include "proofmass/signal/spectrum/regress_out.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

void add_noise_flags(CLI::App& verb, NoiseCommand& command) {
  verb.add_option("FILE", command.files, "static recordings; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--statistic", command.statistic, "NAME",
      "oadev (default), adev, mdev, tdev, hdev, ohdev, totdev, mtotdev, ttotdev, htotdev, theo1 or "
      "pdev")
      ->check(CLI::IsMember({"oadev", "adev", "mdev", "tdev", "hdev", "ohdev", "totdev", "mtotdev",
                             "ttotdev", "htotdev", "theo1", "pdev"}));
  add("--taus", command.taus, "LIST",
      "octave, decade, all, N-per-decade (default 16) or seconds \"1,2,10\"");
  add("--stop-ratio", command.stop_ratio, "X",
      "length of the recording over the longest averaging time (default: the statistic's)")
      ->check(number("a number of 1 or more", [](double x) { return x >= 1.0; }));
  add("--data", command.data, "KIND", "rate (default) or phase, its integral over time")
      ->check(CLI::IsMember({"rate", "phase"}));
  add("--confidence", command.confidence, "P",
      "confidence level of the deviation's limits (default 0.683)")
      ->check(number("a number between 0 and 1", [](double x) { return x > 0.0 && x < 1.0; }));
  add("--noise-type", command.noise_type, "TYPE",
      "noise type used for the confidence limits: auto (default), lag1, or the power of f from -4 "
      "to 2");
  verb.add_flag("--exclude-events", command.exclude_events,
                "exclude outliers, and intervals that span a step");
  CLI::Option* as_one = verb.add_flag("--as-one", command.as_one,
                                      "analyse the files as one recording with gaps between them");
  add("--starts", command.starts_s, "S,S...",
      "start of each file in seconds, with --as-one (default: by the files' own clocks)")
      ->delimiter(',')
      ->check(finite())
      ->needs(as_one);
  // Hidden: used by the processes of `fleet noise --by`.
  add("--sums", command.sums, "KEY/PLACE", "print the sums of one file, to be joined by --as-one")
      ->group("");
  add("--temperature", command.temperature, "NAME",
      "remove the linear dependence on this channel, by least squares");
  add("--update-sensor", command.update_sensor, "FILE.toml",
      "write the coefficients into this sensor file");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the deviation curves");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  add_memory_flag(verb, command.input);
  verb.footer("Example:\n  proofmass noise rest.csv --rate 100 --unit g --report noise.html");
}

using characterise::NoiseAnalysis;
using characterise::NoiseOptions;
using characterise::NoiseTypeSource;
using characterise::TauGrid;

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::vector<double> times_of(std::string_view list) {
  std::vector<double> times_s;
  while (true) {
    const std::size_t comma = list.find(',');
    const auto time_s = number_of<double>(list.substr(0, comma));
    if (!time_s || !std::isfinite(*time_s) || *time_s <= 0.0) return {};
    times_s.push_back(*time_s);
    if (comma == std::string_view::npos) return times_s;
    list.remove_prefix(comma + 1);
  }
}

// "octave", "decade", "all", "16-per-decade" or "1,2,10" in seconds.
TauGrid parse_taus(const std::string& text, double stop_ratio) {
  TauGrid grid;
  grid.stop_ratio = stop_ratio;
  constexpr std::string_view per_decade = "-per-decade";
  if (text == "octave") {
    grid.kind = TauGrid::Kind::octave;
  } else if (text == "decade") {
    grid.kind = TauGrid::Kind::decade;
  } else if (text == "all") {
    grid.kind = TauGrid::Kind::all;
  } else if (text.ends_with(per_decade)) {
    const auto count =
        number_of<int>(std::string_view(text).substr(0, text.size() - per_decade.size()));
    constexpr int most = 1000;
    if (!count || *count < 1 || *count > most) {
      throw Failure(usage,
                    fmt::format("--taus: expected 1 to {} per decade, not '{}'", most, text));
    }
    grid.per_decade = *count;
  } else if (!text.empty()) {
    grid.kind = TauGrid::Kind::given;
    grid.times_s = times_of(text);
    if (grid.times_s.empty()) {
      throw Failure(usage,
                    fmt::format("--taus: expected octave, decade, all, N-per-decade or a list of "
                                "seconds \"1,2,10\", not '{}'",
                                text));
    }
  }
  return grid;
}

void take_temperature_out(const RestTemperature& cause,
                          NoiseChannel& channel,
                          std::vector<Note>& notes) {
  if (channel.rest.series.empty()) return;
  const std::string& name = channel.rest.title;
  const Result<Uncertain> found = signal::regress_out(channel.rest.series.edit(), cause.series);
  if (!found) {
    notes.push_back(
        {Severity::warning, fmt::format("{}: {} was not taken out: {}", name, cause.name,
                                        report::with_flags(found.error()))});
    return;
  }
  const bool known = cause.unit.quantity == Quantity::temperature;
  channel.shown.temperature = {cause.name, *found, known ? "K" : "1"};
  notes.push_back(
      {Severity::info, fmt::format("{}: {} {} per {} were taken out with {}, by least squares",
                                   name, report::with_std(*found), channel.rest.unit.symbol,
                                   channel.shown.temperature->per, cause.name)});
}

std::vector<NoiseChannel> noise_channels(RestRecording recording, std::vector<Note>& notes) {
  std::vector<NoiseChannel> channels;
  for (RestChannel& rest : recording.channels) {
    NoiseChannel& channel = channels.emplace_back();
    channel.rest = std::move(rest);
    channel.shown.name = channel.rest.title;
    channel.shown.unit = channel.rest.unit;
    channel.shown.refused = channel.rest.refused;
    if (recording.temperature) take_temperature_out(*recording.temperature, channel, notes);
  }
  return channels;
}

// All files' channels: prepared, or already analysed for a file larger than --memory.
std::vector<NoiseChannel> noise_channels(const NoiseCommand& command,
                                         const NoiseOptions& options,
                                         std::vector<Note>& notes) {
  const RestOptions rest{.files = command.files,
                         .input = command.input,
                         .output = command.output,
                         .temperature = command.temperature,
                         .for_sensor_file = !command.update_sensor.empty(),
                         .rates_for_sensor_file = true,
                         .is_phase = command.data == "phase",
                         .leave_rest = true};
  std::vector<NoiseChannel> all;
  for (const std::string& file : command.files) {
    auto opened = open_rest(file, rest);
    auto* recording = std::get_if<Recording>(&opened);
    std::vector<NoiseChannel> channels =
        recording != nullptr
            ? noise_channels(rest_recording(std::move(*recording), rest, notes), notes)
            : analyse_pieces(std::get<io::RecordingStream>(std::move(opened)), rest, options,
                             notes);
    std::ranges::move(channels, std::back_inserter(all));
  }
  return all;
}

void analyse(NoiseChannel& channel, NoiseOptions options) {
  if (channel.shown.analysis || !channel.shown.refused.empty()) return;
  options.rate_hz = channel.rest.rate_hz;
  options.lsb = channel.rest.lsb;
  Result<NoiseAnalysis> found = characterise::analyse_noise(channel.rest.series, options);
  // Invalid options, for this channel or for any.
  if (!found && found.error().code == Errc::invalid_argument) {
    throw Failure(usage, found.error().at(channel.shown.name));
  }
  if (found)
    channel.shown.analysis = std::move(found).value();
  else
    channel.shown.refused = found.error().message;
}

// Analyses the channels, and beside that finds where they are at rest, unless that is known.
void analyse_all(const NoiseCommand& command,
                 const NoiseOptions& options,
                 std::vector<NoiseChannel>& channels) {
  const bool seek_rests = !command.as_one && command.data != "phase";
  const std::size_t count = channels.size();
  std::vector<RestChannel*> rests;
  rests.reserve(count);
  for (NoiseChannel& channel : channels) rests.push_back(&channel.rest);
  in_parallel(count + (seek_rests ? 1 : 0), progress_bar(command.output),
              [&](std::size_t k, Progress progress) {
                if (k == count) {
                  find_share_at_rest(first_used_s(command.input), rests);
                  return progress("rests", 1.0);
                }
                NoiseOptions own = options;
                own.progress = std::move(progress);
                analyse(channels[k], std::move(own));
              });
  for (NoiseChannel& channel : channels)
    if (channel.rest.rest) channel.shown.rest = channel.rest.rest;
}

sensor::MeasuredCoefficient measured(const characterise::Coefficient& found) {
  if (found.verdict == characterise::Verdict::identified) {
    return {Uncertain{found.value, found.std}, std::nullopt};
  }
  return {std::nullopt, found.upper_95};
}

sensor::MeasuredNoise measured(const NoiseChannel& channel) {
  const NoiseAnalysis& analysis = *channel.shown.analysis;
  sensor::MeasuredNoise noise;
  noise.axis = *channel.rest.axis;
  noise.gyroscope = channel.rest.unit.quantity == Quantity::angular_rate;
  noise.white = measured(analysis.model.white);
  noise.quantisation = measured(analysis.model.quantisation);
  noise.flicker = measured(analysis.model.flicker);
  noise.random_walk = measured(analysis.model.random_walk);
  noise.ramp = measured(analysis.model.ramp);
  noise.bandwidth_hz = analysis.model.bandwidth_hz;
  const std::string origin = fmt::format(
      "proofmass noise {}, {} at {} Hz", report::file_name(channel.rest.file),
      report::duration_words(analysis.duration_s), report::compact(analysis.rate_hz, 6));
  if (channel.rest.lsb && !noise.gyroscope)
    noise.lsb = sensor::make_figure(*channel.rest.lsb, "m/s^2", origin);
  noise.origin = origin;
  return noise;
}

void update_noise(const std::string& path, const std::vector<NoiseChannel>& channels) {
  std::vector<sensor::MeasuredNoise> noise;
  for (const NoiseChannel& channel : channels) {
    const auto& analysis = channel.shown.analysis;
    if (analysis && analysis->model.ordinates > 0) noise.push_back(measured(channel));
  }
  if (noise.empty()) return;
  const Status status = sensor::update_sensor_file(path, noise);
  if (!status) throw Failure(status_of(status.error(), Stage::writing), status.error());
}

}  // namespace

NoiseOptions noise_options(const NoiseCommand& command) {
  NoiseOptions options;
  options.statistic = characterise::parse_statistic(command.statistic).value();
  options.taus = parse_taus(command.taus, command.stop_ratio.value_or(0.0));
  options.confidence = command.confidence;
  options.exclude_events = command.exclude_events;
  if (command.data == "phase") options.kind = characterise::SeriesKind::phase;
  if (command.noise_type == "lag1") {
    options.noise_type = NoiseTypeSource::lag1;
  } else if (command.noise_type != "auto") {
    const auto alpha = number_of<int>(command.noise_type);
    if (!alpha || *alpha < -4 || *alpha > 2) {
      throw Failure(usage,
                    "--noise-type: expected auto, lag1 or a whole number from -4 to 2, not '" +
                        command.noise_type + "'");
    }
    options.noise_type = NoiseTypeSource::fixed;
    options.alpha = *alpha;
  }
  return options;
}

void run_noise(const NoiseCommand& command) {
  const NoiseOptions options = noise_options(command);
  if (!command.sums.empty()) return print_sums(command, options);
  report::NoiseReport report;
  report.inputs = command.files;
  report.events_excluded = command.exclude_events;
  std::vector<NoiseChannel> channels =
      !command.as_one       ? noise_channels(command, options, report.notes)
      : holds_sums(command) ? join_sums(command, options, report.inputs, report.notes)
                            : analyse_joined(command, options, report.notes);
  analyse_all(command, options, channels);
  if (!command.update_sensor.empty()) {
    without_interruption([&] { update_noise(command.update_sensor, channels); });
  }
  for (NoiseChannel& channel : channels) report.channels.push_back(std::move(channel.shown));
  finish(report::describe(report), [&] { return report::noise_series(report); }, command.output);
}

Verb noise_verb() {
  return make_verb<NoiseCommand>(
      {.name = "noise",
       .group = "Characterise",
       .help = "Allan deviation, spectrum and noise coefficients of a static sensor"},
      add_noise_flags, run_noise);
}

}  // namespace proofmass::app
