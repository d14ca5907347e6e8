#include "proofmass/report/drift_report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>

#include "proofmass/report/drift_wording.hpp"
#include "proofmass/report/noise_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftFit;
using characterise::Interval95;
using Rows = std::vector<std::vector<std::string>>;

std::string heading(const DriftReport& report, const ChannelDrift& channel) {
  const DriftAnalysis& analysis = *channel.analysis;
  std::string text = fmt::format("{}: {} at {} Hz, {}", channel_label(report, channel),
                                 duration_words(analysis.duration_s), compact(analysis.rate_hz, 6),
                                 count_words(analysis.samples, "sample"));
  if (analysis.missing > 0) text += ", " + grouped(analysis.missing) + " of them missing";
  if (analysis.start_s > 0.0)
    text += ", from " + duration_words(analysis.start_s) + " after switching on";
  return text + "\n";
}

Rows parameter_rows(const ChannelDrift& channel) {
  const DriftFit& fit = channel.analysis->fit;
  const Unit& unit = channel.unit;
  Rows rows;
  const auto add_bias = [&](const char* name, const std::optional<Interval95>& figure) {
    if (figure)
      rows.push_back({name, bias_words(*figure, unit), bias_interval_words(*figure, unit)});
  };
  const auto add_time = [&](const char* name, const std::optional<Interval95>& figure) {
    if (!figure) return;
    rows.push_back(
        {name, with_std(Uncertain{figure->value, figure->std}, "s"), time_interval_words(*figure)});
  };
  rows.push_back({"", shape_words(fit.curve.shape), "95 % interval"});
  add_bias(level_words(channel).c_str(), fit.a2);
  add_bias("Warm-up a1", fit.a1);
  add_time("Time constant T", fit.time_constant_s);
  add_bias("Second warm-up", fit.second_a1);
  add_time("Its time constant", fit.second_time_constant_s);
  if (fit.slope_per_s) rows.push_back({"Slope a3", slope_words(*fit.slope_per_s, unit)});
  rows.push_back({"Residuals, rms", bias_words(channel.analysis->residual_rms, unit)});
  return rows;
}

Rows step_rows(const ChannelDrift& channel) {
  constexpr std::size_t most_rows = 10;
  Rows rows;
  const auto& steps = channel.analysis->fit.curve.steps;
  for (const characterise::DriftStep& step : steps) {
    if (rows.size() == most_rows) {
      rows.push_back({"…", count_words(steps.size(), "step") + " in all"});
      break;
    }
    rows.push_back({"Step", compact(step.t_s, 6) + " s", bias_words(step.size, channel.unit)});
  }
  return rows;
}

// The verdict, and that the sensor moved, stand above the table.
std::string channel_text(const DriftReport& report, const ChannelDrift& channel) {
  if (!channel.analysis) {
    return fmt::format("{}: {}\n", channel_label(report, channel), drift_verdict(channel));
  }
  const std::vector<std::string> sentences = drift_findings(channel);
  const std::size_t above = motion_sentence(channel.rest, "drift").empty() ? 1 : 2;
  std::string text = heading(report, channel);
  for (std::size_t k = 0; k < above; ++k) text += "  " + sentences[k] + '\n';
  text += '\n' + aligned(parameter_rows(channel));
  const Rows steps = step_rows(channel);
  if (!steps.empty()) text += '\n' + aligned(steps);
  text += '\n';
  for (std::size_t k = above; k < sentences.size(); ++k) text += "  " + sentences[k] + '\n';
  return text;
}

std::string runs_text(const ChannelRuns& runs) {
  const std::size_t count = runs.set ? runs.set->runs.size() : 0;
  std::string text = runs.set ? fmt::format("{}: {} of {}\n", runs.name, count_words(count, "run"),
                                            duration_words(runs.set->duration_s))
                              : runs.name + ": several runs\n";
  for (const std::string& sentence : run_findings(runs)) text += "  " + sentence + '\n';
  return text;
}

// Of many channels, how many warm up.
std::string counted_conclusion(const DriftReport& report) {
  const auto warm = std::ranges::count_if(report.channels, [](const ChannelDrift& channel) {
    return channel.analysis && channel.analysis->fit.identified;
  });
  const auto refused = std::ranges::count_if(
      report.channels, [](const ChannelDrift& channel) { return !channel.analysis; });
  std::string text = fmt::format("A warm-up is identified in {} of {}", warm,
                                 count_words(report.channels.size(), "channel"));
  if (refused > 0) text += fmt::format(", {} not analysed", refused);
  return text + ".";
}

void add_notes(const ChannelDrift& channel, const std::string& label, std::vector<Note>& notes) {
  if (!channel.analysis) {
    notes.push_back({Severity::bad, label + "not analysed: " + channel.refused});
    return;
  }
  if (const std::string moving = motion_sentence(channel.rest, "drift"); !moving.empty())
    notes.push_back({Severity::bad, label + moving});
  for (const Note& note : channel.analysis->notes) {
    notes.push_back({note.severity, label + note.text});
  }
  if (!channel.temperature || !channel.temperature->model) return;
  for (const std::string& text : channel.temperature->model->notes) {
    notes.push_back({Severity::warning, label + "temperature: " + text});
  }
}

void add_notes(const ChannelRuns& runs, std::vector<Note>& notes) {
  const std::string label = runs.name + ": runs: ";
  if (!runs.set) {
    notes.push_back({Severity::bad, label + "not compared: " + runs.refused});
    return;
  }
  for (const std::string& text : runs.set->notes) {
    notes.push_back({Severity::warning, label + text});
  }
  for (const Note& note : runs.set->warm_up.notes) {
    notes.push_back({note.severity, label + "mean of all: " + note.text});
  }
}

std::string names_of_moving(const DriftReport& report) {
  std::string names;
  for (const ChannelDrift& channel : report.channels) {
    if (motion_sentence(channel.rest, "drift").empty()) continue;
    names += (names.empty() ? "" : ", ") + channel_label(report, channel);
  }
  return names;
}

struct Block {
  double value, fitted, fitted_std, bias;
};

std::map<double, Block> blocks_of(const DriftAnalysis& analysis) {
  std::map<double, Block> blocks;
  for (std::size_t k = 0; k < analysis.block_mean.size(); ++k) {
    const double t_s = analysis.block_time_s(k);
    blocks[t_s] = {analysis.block_mean[k], analysis.fit.curve.value(t_s),
                   analysis.fit.curve.std(t_s), analysis.block_bias[k]};
  }
  return blocks;
}

void add_columns(const std::string& name,
                 const ChannelDrift& channel,
                 const std::vector<double>& times_s,
                 Recording& table) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::map<double, Block> blocks = blocks_of(*channel.analysis);
  std::vector<double> values, fitted, fitted_std, bias;
  for (const double t_s : times_s) {
    const auto at = blocks.find(t_s);
    const Block block = at == blocks.end() ? Block{none, none, none, none} : at->second;
    values.push_back(block.value);
    fitted.push_back(block.fitted);
    fitted_std.push_back(block.fitted_std);
    bias.push_back(block.bias);
  }
  table.channels.push_back({name, channel.unit, std::move(values)});
  table.channels.push_back({name + "_fit", channel.unit, std::move(fitted)});
  table.channels.push_back({name + "_fit_std", channel.unit, std::move(fitted_std)});
  table.channels.push_back({name + "_bias", channel.unit, std::move(bias)});
}

}  // namespace

std::string drift_conclusion(const DriftReport& report) {
  constexpr std::size_t most_told = 3;
  std::string text;
  if (const std::string moving = names_of_moving(report); !moving.empty())
    text = motion_sentence_of_channels(moving);
  if (report.channels.size() > most_told) {
    text += (text.empty() ? "" : " ") + counted_conclusion(report);
  } else {
    for (const ChannelDrift& channel : report.channels) {
      text += (text.empty() ? "" : " ") + channel_label(report, channel) + ": " +
              drift_verdict(channel) + ".";
    }
  }
  for (const ChannelRuns& runs : report.runs) {
    if (!runs.set) continue;
    text += fmt::format(" {} over {}: turn-on repeatability {}.", runs.name,
                        count_words(runs.set->runs.size(), "run"),
                        scatter_words(runs.set->turn_on, runs.unit));
  }
  return text;
}

std::vector<Note> drift_notes(const DriftReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ChannelDrift& channel : report.channels) {
    add_notes(channel, channel_label(report, channel) + ": ", notes);
  }
  for (const ChannelRuns& runs : report.runs) add_notes(runs, notes);
  return notes;
}

std::string drift_text(const DriftReport& report) {
  std::string text;
  for (const ChannelRuns& runs : report.runs) text += (text.empty() ? "" : "\n") + runs_text(runs);
  if (!report.runs.empty() && !report.every_run)
    return text + fmt::format("\nRun by run: {} -v prints each.\n", counted_conclusion(report));
  for (const ChannelDrift& channel : report.channels) {
    text += (text.empty() ? "" : "\n") + channel_text(report, channel);
  }
  return text;
}

Recording drift_series(const DriftReport& report) {
  std::set<double> all;
  for (const ChannelDrift& channel : report.channels) {
    if (!channel.analysis) continue;
    const DriftAnalysis& analysis = *channel.analysis;
    for (std::size_t k = 0; k < analysis.block_mean.size(); ++k) {
      all.insert(analysis.block_time_s(k));
    }
  }
  Recording table;
  table.source = "proofmass drift";
  table.format = "series";
  table.time.source = TimeSource::stamps;
  table.time.stamps_s.assign(all.begin(), all.end());
  for (const ChannelDrift& channel : report.channels) {
    if (!channel.analysis) continue;
    add_columns(channel_label(report, channel), channel, table.time.stamps_s, table);
  }
  return table;
}

}  // namespace proofmass::report
