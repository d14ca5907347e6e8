#include <algorithm>
#include <fmt/format.h>

#include "cli/console.hpp"
#include "cli/exit_status.hpp"
#include "cli/flags.hpp"
#include "cli/output.hpp"
#include "drift/runs.hpp"
#include "input/input.hpp"
#include "input/rest_channels.hpp"
#include "proofmass/characterise/drift_analysis.hpp"
#include "proofmass/characterise/temperature_model.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/report/drift/report.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/drift_update.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

struct DriftCommand {
  std::vector<std::string> files;
  std::string temperature, update_sensor, order = "time";
  std::optional<double> forecast_s;
  InputFlags input;
  OutputFlags output;
};

void add_drift_flags(CLI::App& verb, DriftCommand& command) {
  verb.add_option("FILE", command.files,
                  "static recordings from power-on; three or more are compared as power-ups; - is "
                  "standard input (CSV)")
      ->type_name("")
      ->required();
  const auto add = [&verb](const char* name, auto& into, const char* type, const char* help) {
    return verb.add_option(name, into, help)->type_name(type);
  };
  add("--forecast", command.forecast_s, "S", "predict the bias S seconds after power-on")
      ->check(not_negative());
  add("--temperature", command.temperature, "NAME",
      "fit the bias against this channel (default: the only one in a unit of temperature), or "
      "none");
  add("--order", command.order, "ORDER",
      "order of three or more files: time (default; by their absolute time stamps, else by the "
      "numbers in their names) or given (as on the command line)")
      ->check(CLI::IsMember({"time", "given"}));
  add("--update-sensor", command.update_sensor, "FILE.toml",
      "write the identified coefficients into this sensor file");
  add_input_flags(verb, command.input);
  add_switch_on_flag(verb, command.input, "time since power-on at the first sample (default 0)");
  add_output_file(
      verb, command.output,
      "write block means, curve, its standard deviation, and the bias less white noise");
  add_report_flag(verb, command.output);
  add_page_flag(verb, command.output);
  add_output_flags(verb, command.output);
  verb.footer("Example:\n  proofmass drift rest.csv --rate 100 --unit g --report drift.html");
}

using characterise::DriftAnalysis;
using characterise::DriftOptions;

// One channel of one recording, with its temperature and result.
struct DriftChannel {
  const RestChannel* rest = nullptr;
  const RestTemperature* temperature = nullptr;
  report::ChannelDrift shown;
};

RestOptions rest_options(const DriftCommand& command) {
  const bool left = command.temperature == "none";
  return {.files = command.files,
          .input = command.input,
          .output = command.output,
          .temperature = left ? "" : command.temperature,
          .find_temperature = command.temperature.empty(),
          .for_sensor_file = !command.update_sensor.empty(),
          .leave_rest = true};
}

// Time between power-on and the first analysed sample.
double since_switch_on_s(InputFlags flags) {
  flags.since_switch_on_s = flags.since_switch_on_s.value_or(0.0);
  return *on_at_start_s(flags);
}

std::vector<DriftChannel> drift_channels(const std::vector<RestRecording>& recordings) {
  std::vector<DriftChannel> channels;
  for (const RestRecording& recording : recordings) {
    for (const RestChannel& rest : recording.channels) {
      DriftChannel& channel = channels.emplace_back();
      channel.rest = &rest;
      if (recording.temperature) channel.temperature = &*recording.temperature;
      channel.shown.name = rest.name;
      channel.shown.file = rest.file;
      channel.shown.unit = rest.unit;
      channel.shown.refused = rest.refused;
    }
  }
  return channels;
}

// Rejects before the analysis what would fail after it.
void expect_kelvin(const std::vector<RestRecording>& recordings) {
  for (const RestRecording& recording : recordings) {
    const auto& temperature = recording.temperature;
    if (!temperature || temperature->unit.quantity == Quantity::temperature) continue;
    throw Failure(
        usage, fmt::format("{}: --temperature: {} has no unit of temperature: expected "
                           "it in its heading, \"{} (degC)\"",
                           recording.channels.front().file, temperature->name, temperature->name));
  }
}

void expect_future(double forecast_s, double start_s, const std::vector<DriftChannel>& channels) {
  for (const DriftChannel& channel : channels) {
    if (channel.rest->series.empty()) continue;
    const double end_s =
        start_s + static_cast<double>(channel.rest->series.size()) / channel.rest->rate_hz;
    if (forecast_s >= end_s) continue;
    throw Failure(usage,
                  fmt::format("--forecast: {} s after power-on are within {}, which "
                              "ends at {} s: expected a later time",
                              report::compact(forecast_s, 6), report::file_name(channel.rest->file),
                              report::compact(end_s, 6)));
  }
}

report::DriftTemperature against_temperature(const RestChannel& rest,
                                             const RestTemperature& temperature) {
  report::DriftTemperature out;
  out.channel = temperature.name;
  auto found =
      characterise::fit_temperature(rest.series, temperature.series, {.rate_hz = rest.rate_hz});
  if (found)
    out.model = std::move(found).value();
  else
    out.refused = found.error().message;
  return out;
}

report::DriftOutlook outlook_of(const DriftAnalysis& analysis, double forecast_s) {
  report::DriftOutlook out;
  const auto found = characterise::forecast(analysis.fit, forecast_s);
  if (found)
    out.forecast = *found;
  else
    out.refused = found.error().message;
  return out;
}

void analyse(DriftChannel& channel, DriftOptions options, std::optional<double> forecast_s) {
  if (!channel.shown.refused.empty()) return;
  const RestChannel& rest = *channel.rest;
  options.rate_hz = rest.rate_hz;
  Result<DriftAnalysis> found = characterise::analyse_drift(rest.series, options);
  if (!found) {
    channel.shown.refused = found.error().message;
    return;
  }
  channel.shown.analysis = std::move(found).value();
  if (forecast_s) channel.shown.outlook = outlook_of(*channel.shown.analysis, *forecast_s);
  if (channel.temperature)
    channel.shown.temperature = against_temperature(rest, *channel.temperature);
}

// Rest is determined after subtraction of the fitted drift, since the beginning of a strong warm-up
// would be taken for motion. Subtracts the curve from the series, which are not needed any more.
void find_motion(double start_s,
                 std::vector<RestRecording>& recordings,
                 std::vector<DriftChannel>& channels) {
  auto channel = channels.begin();
  for (RestRecording& recording : recordings) {
    const auto first = channel;
    for (RestChannel& rest : recording.channels) {
      const auto& analysis = (channel++)->shown.analysis;
      if (!analysis) continue;
      std::vector<double>& series = rest.series.edit();
      for (std::size_t k = 0; k < series.size(); ++k) {
        const double t_s = analysis->start_s + static_cast<double>(k) / rest.rate_hz;
        series[k] -= analysis->fit.curve.value(t_s);
      }
    }
    find_share_at_rest(start_s, pointers_to(recording.channels));
    for (auto found = first; found != channel; ++found) found->shown.rest = found->rest->rest;
  }
}

Uncertain uncertain(const characterise::Interval95& figure) {
  return {figure.value, figure.std};
}

sensor::MeasuredDrift measured(const DriftChannel& channel) {
  const DriftAnalysis& analysis = *channel.shown.analysis;
  return {.axis = *channel.rest->axis,
          .a1_mps2 = uncertain(*analysis.fit.a1),
          .a2_mps2 = uncertain(analysis.fit.a2),
          .time_constant_s = uncertain(*analysis.fit.time_constant_s),
          .origin = fmt::format(
              "proofmass drift {}, {} at {} Hz", report::file_name(channel.rest->file),
              report::duration_words(analysis.duration_s), report::compact(analysis.rate_hz, 6))};
}

// Writes the axes whose warm-up is identified; notes list the others.
void update_drift(const std::string& path,
                  const std::vector<DriftChannel>& channels,
                  std::vector<Note>& notes) {
  std::vector<sensor::MeasuredDrift> drift;
  for (const DriftChannel& channel : channels) {
    const auto& analysis = channel.shown.analysis;
    const std::string& name = channel.shown.name;
    if (!analysis || !analysis->fit.identified) {
      notes.push_back({Severity::warning,
                       fmt::format("{}: no warm-up is identified: [drift] of this axis stays in {} "
                                   "as it is",
                                   name, path)});
      continue;
    }
    drift.push_back(measured(channel));
    const characterise::DriftShape shape = analysis->fit.curve.shape;
    if (shape == characterise::DriftShape::exponential) continue;
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} takes the larger exponential alone of what was fitted", name, path)});
  }
  if (drift.empty()) return;
  const Status status = sensor::update_sensor_file(path, drift);
  if (!status) throw Failure(status_of(status.error(), Stage::writing), status.error());
}

void run_drift(const DriftCommand& command) {
  report::DriftReport report;
  report.inputs = command.files;
  report.since_switch_on_s = since_switch_on_s(command.input);
  report.forecast_s = command.forecast_s;
  std::vector<RestRecording> recordings = rest_recordings(rest_options(command), report.notes);
  if (command.order == "time") put_in_time_order(recordings, report.notes);
  report.every_run = command.output.verbose;
  std::vector<DriftChannel> channels = drift_channels(recordings);
  expect_kelvin(recordings);
  if (report.forecast_s) expect_future(*report.forecast_s, report.since_switch_on_s, channels);
  in_parallel(channels.size(), progress_bar(command.output), [&](std::size_t k, Progress own) {
    analyse(channels[k],
            {.since_switch_on_s = report.since_switch_on_s, .progress = std::move(own)},
            report.forecast_s);
  });
  report.runs = compare_recordings(recordings, report.since_switch_on_s,
                                   progress_bar(command.output), report.notes);
  find_motion(first_used_s(command.input), recordings, channels);
  if (!command.update_sensor.empty()) {
    without_interruption([&] { update_drift(command.update_sensor, channels, report.notes); });
  }
  for (DriftChannel& channel : channels) report.channels.push_back(std::move(channel.shown));
  finish(report::describe(report), [&] { return report::drift_series(report); }, command.output);
}

}  // namespace

Verb drift_verb() {
  return make_verb<DriftCommand>(
      {.name = "drift",
       .group = "Characterise",
       .help = "warm-up drift of the bias of a static sensor, and whether it is identifiable"},
      add_drift_flags, run_drift);
}

}  // namespace proofmass::app
