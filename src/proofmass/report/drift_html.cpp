#include <fmt/format.h>

#include "proofmass/report/drift_figures.hpp"
#include "proofmass/report/drift_report.hpp"
#include "proofmass/report/drift_tables.hpp"
#include "proofmass/report/drift_wording.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;

// A page of a hundred channels is no page: the more of them, the less of each.
enum class Detail { all, curve, table };

Detail detail_of(const DriftReport& report) {
  constexpr std::size_t most_with_all = 6, most_with_curve = 24;
  const std::size_t channels = report.channels.size();
  if (channels <= most_with_all) return Detail::all;
  return channels <= most_with_curve ? Detail::curve : Detail::table;
}

std::vector<KeyFigure> key_figures(const DriftReport& report) {
  constexpr std::size_t most_channels = 6;
  std::vector<KeyFigure> figures;
  for (const ChannelRuns& runs : report.runs) {
    if (!runs.set) continue;
    figures.push_back(
        {runs.name + ": turn-on repeatability", scatter_words(runs.set->turn_on, runs.unit)});
  }
  if (report.channels.size() > most_channels) return figures;
  for (const ChannelDrift& channel : report.channels) {
    const std::string label = channel_label(report, channel);
    if (!channel.analysis) {
      figures.push_back({label, "not analysed"});
      continue;
    }
    const characterise::DriftFit& fit = channel.analysis->fit;
    figures.push_back(
        {label + ": warm-up a1", fit.a1 ? bias_words(*fit.a1, channel.unit) : "not identified"});
    if (!fit.time_constant_s) continue;
    figures.push_back(
        {label + ": time constant T",
         with_std(Uncertain{fit.time_constant_s->value, fit.time_constant_s->std}, "s")});
  }
  return figures;
}

// A figure stays on one line with its standard deviation and its per cent.
std::string firm(std::string text) {
  for (const std::string part : {" ± ", " %"}) {
    const std::string nbsp = "\u00a0";
    const std::string held = part == " %" ? nbsp + "%" : nbsp + "±" + nbsp;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at)) {
      text.replace(at, part.size(), held);
    }
  }
  return text;
}

std::vector<std::string> firm(std::vector<std::string> sentences) {
  for (std::string& sentence : sentences) sentence = firm(std::move(sentence));
  return sentences;
}

void append(std::vector<Plot>& figures, std::vector<Figure> more) {
  for (Figure& figure : more) figures.push_back(std::move(figure));
}

void add_all(const ChannelDrift& channel, const std::string& label, Section& section) {
  const DriftAnalysis& analysis = *channel.analysis;
  section.tables = {parameters_table(channel)};
  if (!analysis.fit.curve.steps.empty()) section.tables.push_back(steps_table(channel));
  if (!analysis.whiteness.empty()) section.tables.push_back(whiteness_table(analysis));
  section.tables.push_back(candidates_table(analysis.fit));
  if (channel.outlook && channel.outlook->forecast && costs_position(channel.unit)) {
    section.tables.push_back(position_table(*channel.outlook->forecast));
  }
  if (channel.temperature && channel.temperature->model) {
    section.tables.push_back(temperature_table(channel));
  }
  section.figures.push_back(readings_figure(channel, label));
  // Of a time constant that is not identified a profile says little.
  if (analysis.fit.identified && !analysis.fit.profile.empty())
    section.figures.push_back(profile_figure(channel, label));
  append(section.figures, residual_figures(channel, label));
  append(section.figures, autocorrelation_figures(channel, label));
  if (channel.temperature && channel.temperature->model) {
    section.figures.push_back(temperature_figure(channel, label));
  }
}

Section channel_section(const ChannelDrift& channel, const std::string& label, Detail detail) {
  if (!channel.analysis) return {.heading = label, .paragraphs = drift_findings(channel)};
  const DriftAnalysis& analysis = *channel.analysis;
  Section section{
      .heading = fmt::format("{}: {} at {} Hz", label, duration_words(analysis.duration_s),
                             compact(analysis.rate_hz, 6)),
      .points = firm(drift_findings(channel)),
      .figures = {drift_figure(channel, label)}};
  if (detail == Detail::all) add_all(channel, label, section);
  return section;
}

Section overview_section(const DriftReport& report) {
  Table table{"What each comes to", {"Channel", "Verdict", "Bias or level at switching on"}, {}};
  for (const ChannelDrift& channel : report.channels) {
    table.rows.push_back(
        {channel_label(report, channel), drift_verdict(channel),
         channel.analysis ? bias_words(channel.analysis->fit.a2, channel.unit) : ""});
  }
  return {.heading = "All channels", .tables = {std::move(table)}};
}

Section runs_section(const ChannelRuns& runs) {
  if (!runs.set) return {.heading = runs.name + ": runs", .paragraphs = run_findings(runs)};
  ChannelDrift common;
  common.name = runs.name;
  common.unit = runs.unit;
  common.analysis = runs.set->warm_up;
  return {.heading = fmt::format("{}: {}", runs.name, count_words(runs.set->runs.size(), "run")),
          .points = firm(run_findings(runs)),
          .tables = {runs_table(runs)},
          .figures = {levels_figure(runs),
                      drift_figure(common, runs.name + ", mean of all runs less their levels")}};
}

Section method_section() {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "Fitted is y(t) = a2 + a1 (1 − e^(−t/T)), beside a constant, a straight line, steps, an "
          "exponential with a line and two exponentials. White noise, flicker, a random walk and "
          "first-order Markov noise are found together with it, and the shape with the least "
          "Schwarz criterion is taken.",
          "The interval of T is where twice the loss in log-likelihood stays below 3.84, all else "
          "fitted anew: it need not be even about T, and may be open. A standard deviation from a "
          "plain least-squares fit takes the residuals for white; with a random walk in them it is "
          "several times too small.",
          "Whiteness is tested on means over growing times, because a slow drift hides in the "
          "noise of the samples: Ljung–Box over √n lags, the cumulative periodogram, and runs of "
          "sign; white where none is rejected at a joint level of 5 %."}};
}

std::string title_of(const DriftReport& report) {
  constexpr std::size_t most_named = 4;
  std::string title;
  for (std::size_t k = 0; k < report.inputs.size(); ++k) {
    if (k == most_named) return title + fmt::format(" and {} more", report.inputs.size() - k);
    title += (title.empty() ? "" : ", ") + file_name(report.inputs[k]);
  }
  return title;
}

}  // namespace

std::string drift_html(const DriftReport& report) {
  Page page{.verb = "drift",
            .title = title_of(report),
            .inputs = report.inputs,
            .conclusion = firm(drift_conclusion(report)),
            .key_figures = key_figures(report),
            .notes = drift_notes(report)};
  for (const ChannelRuns& runs : report.runs) page.sections.push_back(runs_section(runs));
  const Detail detail = detail_of(report);
  if (detail != Detail::all) page.sections.push_back(overview_section(report));
  if (detail != Detail::table) {
    for (const ChannelDrift& channel : report.channels) {
      page.sections.push_back(channel_section(channel, channel_label(report, channel), detail));
    }
  }
  page.sections.push_back(method_section());
  return html(page);
}

}  // namespace proofmass::report
