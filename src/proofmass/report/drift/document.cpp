#include <algorithm>
#include <fmt/format.h>

#include "proofmass/report/drift/fields.hpp"
#include "proofmass/report/drift/figures.hpp"
#include "proofmass/report/drift/tables.hpp"
#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;
using characterise::DriftFit;
using signal::WhitenessTest;

Fields channel_fields(const ChannelDrift& channel) {
  Fields fields = drift_fields(channel);
  fields.push_back(rest_field(channel.rest));
  return fields;
}

void add_notes(const ChannelDrift& channel, const std::string& label, std::vector<Note>& notes) {
  if (!channel.analysis) return notes.push_back({Severity::bad, label + why_not_analysed(channel)});
  if (const std::string moving = motion_sentence(channel.rest, "drift"); !moving.empty())
    notes.push_back({Severity::bad, label + moving});
  for (const Note& note : channel.analysis->notes)
    notes.push_back({note.severity, label + note.text});
  if (!channel.temperature || !channel.temperature->model) return;
  for (const std::string& text : channel.temperature->model->notes)
    notes.push_back({Severity::warning, label + "temperature: " + text});
}

void add_notes(const ChannelRuns& runs, std::vector<Note>& notes) {
  const std::string label = runs.name + ": runs: ";
  if (!runs.set) return notes.push_back({Severity::bad, label + "not compared: " + runs.refused});
  for (const std::string& text : runs.set->notes)
    notes.push_back({Severity::warning, label + text});
  for (const Note& note : runs.set->warm_up.notes)
    notes.push_back({note.severity, label + "mean of all: " + note.text});
}

// The report's notes, then those of each channel with its name; a refused channel is Severity::bad.
std::vector<Note> all_notes(const DriftReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ChannelDrift& channel : report.channels)
    add_notes(channel, channel_label(report, channel) + ": ", notes);
  for (const ChannelRuns& runs : report.runs) add_notes(runs, notes);
  return notes;
}

Fields report_fields(const DriftReport& report, const std::vector<Note>& notes) {
  Fields fields{field::records("channels", report.channels, channel_fields),
                field::records("runs", report.runs, runs_fields,
                               {.meaning = "of three recordings or more: each channel over them"}),
                field::number("since_switch_on_s", report.since_switch_on_s,
                              {.meaning = "time since power-on at the first sample"})};
  if (report.forecast_s)
    fields.push_back(
        field::number("forecast_s", report.forecast_s, {.meaning = "time of the forecast"}));
  std::vector<std::string> infos;
  for (const Note& note : notes)
    if (note.severity == Severity::info) infos.push_back(with_flags(note));
  fields.push_back(field::texts("notes", infos, {.meaning = "how the input was read"}));
  return fields;
}

// "x: warm-up of 5.0 ± 0.1 mg with time constant 900 ± 20 s."; for many channels, the number that
// warm up.
std::string channels_conclusion(const DriftReport& report) {
  constexpr std::size_t most_named = 3;
  std::string text;
  if (report.channels.size() <= most_named) {
    for (const ChannelDrift& channel : report.channels)
      text += fmt::format("{}{}: {}.", text.empty() ? "" : " ", channel_label(report, channel),
                          drift_verdict(channel));
    return text;
  }
  const auto warm = std::ranges::count_if(report.channels, [](const ChannelDrift& channel) {
    return channel.analysis && channel.analysis->fit.identified;
  });
  const auto refused = std::ranges::count_if(
      report.channels, [](const ChannelDrift& channel) { return !channel.analysis; });
  text = fmt::format("A warm-up is identified in {} of {}", warm,
                     count_words(report.channels.size(), "channel"));
  if (refused > 0) text += fmt::format(", {} not analysed", refused);
  return text + ".";
}

std::string conclusion(const DriftReport& report) {
  std::string moving, text;
  for (const ChannelDrift& channel : report.channels)
    if (!motion_sentence(channel.rest, "drift").empty())
      moving += (moving.empty() ? "" : ", ") + channel_label(report, channel);
  if (!moving.empty()) text = motion_sentence_of_channels(moving) + " ";
  for (const ChannelRuns& runs : report.runs)
    if (runs.set)
      text += fmt::format("{} over {}: turn-on repeatability {}. ", runs.name,
                          count_words(runs.set->runs.size(), "run"),
                          scatter_words(runs.set->turn_on, runs.unit));
  return text + channels_conclusion(report);
}

std::vector<KeyFigure> figures_of(const DriftReport& report) {
  constexpr std::size_t most_channels = 6;
  std::vector<KeyFigure> figures;
  for (const ChannelRuns& runs : report.runs)
    if (runs.set)
      figures.push_back(
          {runs.name + ": turn-on repeatability", scatter_words(runs.set->turn_on, runs.unit)});
  if (report.channels.size() > most_channels) return figures;
  for (const ChannelDrift& channel : report.channels) {
    const std::string label = channel_label(report, channel);
    if (!channel.analysis) {
      figures.push_back({label, "not analysed"});
      continue;
    }
    const DriftFit& fit = channel.analysis->fit;
    figures.push_back(
        {label + ": warm-up a1", fit.a1 ? bias_words(*fit.a1, channel.unit) : "not identified"});
    if (fit.time_constant_s)
      figures.push_back(
          {label + ": time constant T", with_std(uncertain(fit.time_constant_s), "s", absent)});
  }
  return figures;
}

// The more channels, the less detail for each.
enum class Detail { all, curve, table };

Detail detail_of(const DriftReport& report) {
  constexpr std::size_t most_with_all = 6, most_with_curve = 24;
  const std::size_t channels = report.channels.size();
  if (channels <= most_with_all) return Detail::all;
  return channels <= most_with_curve || report.every_run ? Detail::curve : Detail::table;
}

void add_all(const ChannelDrift& channel, const std::string& label, Section& section) {
  const DriftAnalysis& analysis = *channel.analysis;
  const bool has_temperature = channel.temperature && channel.temperature->model;
  if (!analysis.whiteness.empty()) section.tables.push_back(whiteness_table(analysis));
  section.tables.push_back(candidates_table(analysis.fit));
  if (channel.outlook && channel.outlook->forecast && costs_position(channel.unit))
    section.tables.push_back(position_table(*channel.outlook->forecast));
  if (has_temperature) section.tables.push_back(temperature_table(channel));
  section.figures.push_back([&, label] { return samples_figure(channel, label); });
  // The profile of an unidentified time constant is nearly flat.
  if (analysis.fit.identified && !analysis.fit.profile.empty())
    section.figures.push_back([&, label] { return profile_figure(channel, label); });
  for (std::size_t k = 0; k < analysis.residuals.size(); ++k)
    section.figures.push_back([&, label, k] { return residual_figure(channel, k, label); });
  for (const WhitenessTest& test : analysis.whiteness)
    section.figures.push_back([&, label] { return autocorrelation_figure(test, label); });
  if (has_temperature)
    section.figures.push_back([&, label] { return temperature_figure(channel, label); });
}

std::string data_words(const DriftAnalysis& analysis) {
  std::string text = fmt::format("{} at {} Hz, {}", count_words(analysis.samples, "sample"),
                                 compact(analysis.rate_hz, 6), duration_words(analysis.duration_s));
  if (analysis.missing > 0) text += ", " + grouped(analysis.missing) + " of them missing";
  if (analysis.start_s > 0.0)
    text += ", from " + duration_words(analysis.start_s) + " after power-on";
  return text + ".";
}

Section channel_section(const DriftReport& report, const ChannelDrift& channel, Detail detail) {
  const std::string label = channel_label(report, channel);
  Section section{.heading = label,
                  .points = drift_findings(channel),
                  .on_terminal = report.runs.empty() || report.every_run};
  if (!channel.analysis) return section;
  section.paragraphs = {data_words(*channel.analysis)};
  section.tables = {parameters_table(channel)};
  if (!channel.analysis->fit.curve.steps.empty()) section.tables.push_back(steps_table(channel));
  section.figures = {[&, label] { return drift_figure(channel, label); }};
  if (detail == Detail::all) add_all(channel, label, section);
  return section;
}

// The terminal shows the table if the channels have no sections of their own.
Section overview_section(const DriftReport& report, Detail detail) {
  Table table{"Verdicts", {"Channel", "Verdict", "Bias or level at power-on"}, {}};
  table.page_only = !report.runs.empty() || detail != Detail::table;
  for (const ChannelDrift& channel : report.channels)
    table.rows.push_back(
        {channel_label(report, channel), drift_verdict(channel),
         channel.analysis ? bias_words(channel.analysis->fit.a2, channel.unit) : ""});
  Section section{.heading = "All channels", .tables = {std::move(table)}, .on_terminal = true};
  if (!report.runs.empty() && !report.every_run)
    section.paragraphs = {"On a terminal, -v prints each run in full."};
  return section;
}

Section runs_section(const ChannelRuns& runs) {
  Section section{
      .heading = runs.name + ": runs", .points = run_findings(runs), .on_terminal = true};
  if (!runs.set) return section;
  section.heading =
      fmt::format("{}: {} of {}", runs.name, count_words(runs.set->runs.size(), "run"),
                  duration_words(runs.set->duration_s));
  section.tables = {runs_table(runs)};
  section.figures = {[&] { return levels_figure(runs); },
                     [&] {
                       return drift_figure(common_warm_up(runs),
                                           runs.name + ", mean of all runs less their levels");
                     }};
  return section;
}

Section method_section() {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "The model y(t) = a2 + a1 (1 − e^(−t/T)) is compared with a constant, a straight line, "
          "steps, an exponential with a line, two exponentials and other shapes. White noise, "
          "flicker, a random walk and first-order Markov noise are fitted jointly; the shape with "
          "the least Schwarz criterion is chosen.",
          "The interval of T contains the values for which twice the loss in log-likelihood stays "
          "below 3.84, all else refitted: it may be asymmetric or open. The standard deviation of "
          "an ordinary least-squares fit assumes white residuals; with a random walk in them it is "
          "several times too small.",
          "Whiteness is tested on means over increasing times, because slow drift is hidden by the "
          "noise of single samples: Ljung–Box over √n lags, the cumulative periodogram, and runs "
          "of sign, at a joint level of 5 %."}};
}

}  // namespace

Document describe(const DriftReport& report) {
  const std::vector<Note> notes = all_notes(report);
  Document document{.page = {.verb = "drift",
                             .title = file_names(report.inputs),
                             .inputs = report.inputs,
                             .conclusion = conclusion(report),
                             .key_figures = figures_of(report),
                             .notes = notes},
                    .fields = report_fields(report, notes),
                    .failure = why_no_channel(report.channels)};
  std::vector<Section>& sections = document.page.sections;
  const Detail detail = detail_of(report);
  for (const ChannelRuns& runs : report.runs) sections.push_back(runs_section(runs));
  if (detail != Detail::all || !report.runs.empty())
    sections.push_back(overview_section(report, detail));
  if (detail != Detail::table)
    for (const ChannelDrift& channel : report.channels)
      sections.push_back(channel_section(report, channel, detail));
  sections.push_back(method_section());
  return document;
}

}  // namespace proofmass::report
