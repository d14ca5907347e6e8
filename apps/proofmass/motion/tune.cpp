#include "proofmass/estimate/tune.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "input/input.hpp"
#include "input/rest_channels.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/report/tune/report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/noise_update.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

/// Q, R and the time constant of a bias from one recording.
struct TuneCommand {
  std::string file;
  std::string model = "auto";
  std::vector<std::string> fix, share;  ///< --fix NAME=VALUE, --share NAME
  bool from_sensor = false;             ///< initial values from the noise of the sensor file
  double study_step_s = 0.0;            ///< 0: the recording's own interval
  std::string update_sensor;
  InputFlags input;
  OutputFlags output;
};

void add_tune_flags(CLI::App& verb, TuneCommand& command) {
  verb.add_option("FILE", command.file, "a recording; - is standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--model", command.model, "MODEL",
      "auto (default): rest if it rests nearly throughout, else pva; rest, rest-markov, pva, "
      "pva-bias, local-level, local-trend, position")
      ->check(CLI::IsMember({"auto", "rest", "rest-markov", "pva", "pva-bias", "local-level",
                             "local-trend", "position"}));
  add("--fix", command.fix, "NAME=VALUE", "hold a parameter, in SI; may be repeated")
      ->allow_extra_args(false);
  add("--share", command.share, "NAME",
      "one value of this parameter for all channels; may be "
      "repeated")
      ->allow_extra_args(false);
  verb.add_flag("--start-at-sensor", command.from_sensor,
                "start at the noise of the --sensor file instead of the Allan deviation");
  add("--study-step", command.study_step_s, "S",
      "step of the study of gain and covariance (default: the recording's)")
      ->check(positive());
  add("--update-sensor", command.update_sensor, "FILE.toml",
      "write white noise and random walk into this sensor file (model rest)");
  add_input_flags(verb, command.input);
  add_output_file(verb, command.output, "write the innovations with standard deviations");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer(
      "Examples:\n"
      "  proofmass tune rest.csv --rate 100 --unit g\n"
      "  proofmass tune stroke.csv --model pva --share jerk_psd --report tune.html");
}

using estimate::TuneChoice;
using estimate::TunedParameter;
using estimate::TuneModel;
using estimate::TuneOptions;
using estimate::TuneSeries;
using estimate::Tuning;

estimate::FixedParameter parse_fixed(const std::string& text) {
  const std::size_t at = text.find('=');
  estimate::FixedParameter fixed{text.substr(0, at), 0.0};
  const char* from = text.data() + std::min(at, text.size() - 1) + 1;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(from, end, fixed.value);
  if (at == std::string::npos || error != std::errc() || stop != end) {
    throw Failure(usage, "--fix: expected NAME=VALUE, as in jerk_psd=0.5, not '" + text + "'");
  }
  return fixed;
}

bool may_rest(const RestRecording& recording) {
  return std::ranges::all_of(recording.channels, [](const RestChannel& channel) {
    const Quantity quantity = channel.unit.quantity;
    return channel.axis || quantity == Quantity::acceleration || quantity == Quantity::counts ||
           quantity == Quantity::voltage;
  });
}

TuneChoice choose(const TuneCommand& command, const RestRecording& recording) {
  constexpr std::size_t most_axes = 3;
  estimate::TuneChoiceOptions options{.measures_acceleration = may_rest(recording)};
  if (command.model != "auto") options.given = estimate::parse_tune_model(command.model);
  std::vector<View<double>> axes;
  for (const RestChannel& channel : recording.channels) {
    if (channel.series.empty() || axes.size() == most_axes) continue;
    axes.emplace_back(channel.series);
    options.rate_hz = channel.rate_hz;
  }
  return estimate::choose_tune_model(axes, options);
}

// Initial values from the sensor file, if it has the noise of the axis.
void start_at_sensor(const RestChannel& channel,
                     const sensor::SensorModel& model,
                     TuneOptions& options) {
  if (!channel.axis) return;
  const auto add = [&](const char* name, const sensor::AxisFigures& figures) {
    const auto& figure = figures[*channel.axis];
    if (figure && figure->si() > 0.0) options.start.push_back({name, figure->si()});
  };
  add("white", model.noise.white);
  add("random_walk", model.noise.random_walk);
}

Failure failure_of(const Error& error) {
  const bool asked = error.code == Errc::invalid_argument;
  return {asked ? usage : status_of(error, Stage::computing), error.message};
}

struct Tuned {
  std::optional<Tuning> tuning;
  std::string refused;
};

// All channels jointly if they share a parameter, else each separately.
std::vector<Tuned> tune_all(const std::vector<TuneSeries>& series,
                            const std::vector<TuneOptions>& options,
                            const OutputFlags& output) {
  const bool together = !options.front().shared.empty();
  std::vector<Tuned> all(together ? 1 : series.size());
  in_parallel(all.size(), progress_bar(output), [&](std::size_t k, Progress progress) {
    TuneOptions own = options[k];
    own.progress = std::move(progress);
    Result<Tuning> found = estimate::tune(together ? series : std::vector{series[k]}, own);
    if (found) {
      all[k].tuning = std::move(found).value();
    } else if (found.error().code == Errc::invalid_argument || together) {
      throw failure_of(found.error());
    } else {
      all[k].refused = found.error().message;
    }
  });
  return all;
}

sensor::MeasuredCoefficient measured(const Tuning& tuning,
                                     std::string_view name,
                                     std::size_t series) {
  for (const TunedParameter& parameter : tuning.parameters) {
    if (parameter.name != name || (parameter.series && *parameter.series != series)) continue;
    if (parameter.verdict == estimate::TuneVerdict::fixed) return {};
    if (parameter.value) return {parameter.value, std::nullopt};
    return {std::nullopt, parameter.upper_95};
  }
  return {};
}

void update_sensor(const TuneCommand& command,
                   const report::TuneReport& report,
                   const std::vector<const RestChannel*>& channels) {
  std::vector<sensor::MeasuredNoise> noise;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    sensor::MeasuredNoise own;
    own.axis = *channels[k]->axis;
    own.white = measured(report.tuning, "white", k);
    own.random_walk = measured(report.tuning, "random_walk", k);
    own.origin = fmt::format("proofmass tune {}, {} at {} Hz", report::file_name(command.file),
                             report::duration_words(report.tuning.series[k].duration_s),
                             report::compact(report.tuning.series[k].rate_hz, 6));
    noise.push_back(std::move(own));
  }
  const Status status = sensor::update_sensor_file(command.update_sensor, noise);
  if (!status) throw Failure(status_of(status.error(), Stage::writing), status.error());
}

// The sensor file's noise of each channel, for --start-at-sensor.
std::vector<TuneOptions> options_of(const TuneCommand& command,
                                    TuneModel model,
                                    const std::vector<const RestChannel*>& channels) {
  TuneOptions options{.model = model, .shared = command.share};
  for (const std::string& text : command.fix) options.fixed.push_back(parse_fixed(text));
  std::vector<TuneOptions> all(channels.size(), options);
  if (!command.from_sensor) return all;
  if (command.input.sensors.empty() || !estimate::is_of_rest(model)) {
    throw Failure(usage, "--start-at-sensor: expected --sensor FILE.toml and a model of rest");
  }
  std::vector<Note> unused;
  const auto models = load_sensors(command.input, unused);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    start_at_sensor(*channels[k], models.front(), all[k]);
  }
  return all;
}

void refuse(const std::string& name, const std::string& why, std::vector<Note>& notes) {
  notes.push_back({Severity::bad, name + ": not tuned: " + why});
}

// The channels usable for tuning; notes give the reasons for the others.
std::vector<const RestChannel*> usable(const RestRecording& recording, std::vector<Note>& notes) {
  std::vector<const RestChannel*> channels;
  for (const RestChannel& channel : recording.channels) {
    if (channel.refused.empty()) {
      channels.push_back(&channel);
    } else {
      refuse(channel.title, channel.refused, notes);
    }
  }
  return channels;
}

// Tunes on the channels and keeps those for which it succeeded.
void fill(const TuneCommand& command,
          const TuneChoice& choice,
          std::vector<const RestChannel*>& channels,
          report::TuneReport& report) {
  std::vector<TuneSeries> series;
  for (const RestChannel* channel : channels)
    series.push_back(
        estimate::tune_series(channel->title, channel->rate_hz, channel->series, choice));
  const std::vector<Tuned> tuned =
      tune_all(series, options_of(command, choice.model, channels), command.output);
  std::vector<const RestChannel*> worked;
  for (std::size_t k = 0; k < tuned.size(); ++k) {
    if (!tuned[k].tuning) {
      refuse(channels[k]->title, tuned[k].refused, report.notes);
      continue;
    }
    estimate::append(report.tuning, *tuned[k].tuning);
    worked.push_back(channels[k]);
  }
  if (worked.empty()) throw Failure(failed, command.file + ": " + tuned.front().refused);
  if (command.share.empty()) channels = std::move(worked);
  for (const RestChannel* channel : channels) {
    report.channels.push_back(
        {channel->title, channel->unit, std::max<std::size_t>(choice.rests.size(), 1)});
  }
  for (Note& note : report::outlier_notes(report)) report.notes.push_back(std::move(note));
  report.consistency = estimate::consistency_of(report.tuning);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (auto study = estimate::tune_study(report.tuning, k, command.study_step_s))
      report.studies.push_back(std::move(*study));
  }
}

void run_tune(const TuneCommand& command) {
  report::TuneReport report;
  report.inputs = {command.file};
  const std::vector<RestRecording> recordings =
      rest_recordings({.files = report.inputs,
                       .input = command.input,
                       .output = command.output,
                       .temperature = {},
                       .for_sensor_file = !command.update_sensor.empty()},
                      report.notes);
  const TuneChoice choice = choose(command, recordings.front());
  if (!command.update_sensor.empty() && choice.model != TuneModel::rest) {
    throw Failure(usage, "--update-sensor: a sensor file takes the figures of the model rest");
  }
  report.choice = choice;
  std::vector<const RestChannel*> channels = usable(recordings.front(), report.notes);
  if (channels.empty()) throw Failure(failed, command.file + ": no channel that can be tuned by");
  fill(command, choice, channels, report);
  if (!command.update_sensor.empty()) {
    without_interruption([&] { update_sensor(command, report, channels); });
  }
  finish(report::describe(report), [&] { return report::tune_series(report); }, command.output);
}

}  // namespace

Verb tune_verb() {
  return make_verb<TuneCommand>(
      {.name = "tune",
       .group = "Estimate",
       .help = "maximum-likelihood Q, R and bias time constant of a filter from a recording"},
      add_tune_flags, run_tune);
}

}  // namespace proofmass::app
