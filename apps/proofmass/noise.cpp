#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <thread>

#include "console.hpp"
#include "exit_status.hpp"
#include "noise_channels.hpp"
#include "output.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/report/noise_report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/noise_update.hpp"
#include "verbs.hpp"

namespace proofmass::app {
namespace {

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

NoiseOptions options_of(const NoiseCommand& command) {
  NoiseOptions options;
  const auto statistic = characterise::parse_statistic(command.statistic);
  if (!statistic) {
    throw Failure(
        usage, "--statistic: there is no '" + command.statistic + "': see proofmass noise --help");
  }
  options.statistic = *statistic;
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

// Tells one bar of the mean progress of several analyses at once.
class SharedProgress {
 public:
  SharedProgress(Progress shown, std::size_t parts) : shown_(std::move(shown)), done_(parts) {}

  Progress part(std::size_t k) {
    return [this, k](std::string_view, double fraction) {
      const std::scoped_lock lock(mutex_);
      done_[k] = fraction;
      double sum = 0.0;
      for (const double part : done_) sum += part;
      if (shown_) shown_("analysing", sum / static_cast<double>(done_.size()));
    };
  }

 private:
  std::mutex mutex_;
  Progress shown_;
  std::vector<double> done_;
};

void analyse(NoiseChannel& channel, NoiseOptions options) {
  if (!channel.shown.refused.empty()) return;
  options.rate_hz = channel.rate_hz;
  options.lsb = channel.lsb;
  Result<NoiseAnalysis> found = characterise::analyse_noise(channel.series, options);
  // What was asked for makes no sense, of this channel or of any.
  if (!found && found.error().code == Errc::invalid_argument) {
    throw Failure(usage, found.error().at(channel.shown.name).message);
  }
  if (found)
    channel.shown.analysis = std::move(found).value();
  else
    channel.shown.refused = found.error().message;
  std::vector<double>().swap(channel.series);
}

// Each channel by itself, as many at once as there are processors: the results do not depend on it.
void analyse_all(std::vector<NoiseChannel>& channels,
                 const NoiseOptions& options,
                 const Progress& progress) {
  SharedProgress shared(progress, channels.size());
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> troubles(channels.size());
  const auto work = [&] {
    for (std::size_t k = next++; k < channels.size(); k = next++) {
      try {
        NoiseOptions own = options;
        own.progress = shared.part(k);
        analyse(channels[k], std::move(own));
      } catch (...) {
        troubles[k] = std::current_exception();
      }
    }
  };
  {
    const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    for (std::size_t k = 1; k < std::min(processors, channels.size()); ++k) {
      others.emplace_back(work);
    }
    work();
  }
  for (const std::exception_ptr& trouble : troubles) {
    if (trouble) std::rethrow_exception(trouble);
  }
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
  noise.axis = *channel.axis;
  noise.white = measured(analysis.model.white);
  noise.quantisation = measured(analysis.model.quantisation);
  noise.flicker = measured(analysis.model.flicker);
  noise.random_walk = measured(analysis.model.random_walk);
  noise.ramp = measured(analysis.model.ramp);
  noise.bandwidth_hz = analysis.model.bandwidth_hz;
  const std::string origin = fmt::format(
      "proofmass noise {}, {} at {} Hz", report::file_name(channel.file),
      report::duration_words(analysis.duration_s), report::compact(analysis.rate_hz, 6));
  if (channel.lsb) noise.lsb = sensor::make_figure(*channel.lsb, "m/s^2", origin);
  noise.origin = origin;
  return noise;
}

// The axes that a sensor file can take. Throws before the analysis what would be in vain.
void expect_axes(const std::vector<NoiseChannel>& channels) {
  for (const NoiseChannel& channel : channels) {
    const bool fits = channel.axis && channel.shown.unit.symbol == "m/s^2";
    if (fits) continue;
    throw Failure(usage, fmt::format("--update-sensor: {} is no x, y or z axis of one "
                                     "accelerometer, in m/s^2: choose with --channel, say --unit",
                                     channel.shown.name));
  }
}

void update_sensor(const std::string& path, const std::vector<NoiseChannel>& channels) {
  std::vector<sensor::MeasuredNoise> noise;
  for (const NoiseChannel& channel : channels) {
    const auto& analysis = channel.shown.analysis;
    if (analysis && analysis->model.ordinates > 0) noise.push_back(measured(channel));
  }
  if (noise.empty()) return;
  const Status status = sensor::update_sensor_file(path, noise);
  if (!status) throw Failure(status_of(status.error(), Stage::writing), status.error().message);
}

bool is_bad(const std::vector<Note>& notes) {
  return std::ranges::any_of(notes, [](const Note& n) { return n.severity == Severity::bad; });
}

}  // namespace

void run(const NoiseCommand& command) {
  if (command.output.output == "-" && command.output.json == "-") {
    throw Failure(usage, "--output - and --json - cannot both have standard output: name a file");
  }
  if (!command.update_sensor.empty() && command.files.size() > 1) {
    throw Failure(usage, "--update-sensor: a sensor file takes the noise of one recording");
  }
  const NoiseOptions options = options_of(command);
  report::NoiseReport report;
  report.inputs = command.files;
  report.events_excluded = command.exclude_events;
  std::vector<NoiseChannel> channels = noise_channels(command, report.notes);
  if (!command.update_sensor.empty()) expect_axes(channels);
  analyse_all(channels, options, progress_bar(command.output));
  if (!command.update_sensor.empty()) {
    without_interruption([&] { update_sensor(command.update_sensor, channels); });
  }
  for (NoiseChannel& channel : channels) report.channels.push_back(std::move(channel.shown));
  const std::vector<Note> notes = report::noise_notes(report);
  show_notes(notes, "", command.output);
  if (!command.output.output.empty()) {
    write_series(report::noise_series(report), command.output.output);
  }
  publish({.text = [&] { return report::noise_text(report); },
           .json = [&] { return report::noise_json(report); },
           .html = [&] { return report::noise_html(report); }},
          command.output);
  hold_to_strict(command.output, is_bad(notes));
}

}  // namespace proofmass::app
