#include <fmt/format.h>

#include "proofmass/report/noise_figures.hpp"
#include "proofmass/report/noise_report.hpp"
#include "proofmass/report/noise_wording.hpp"
#include "proofmass/report/page.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::NoiseAnalysis;

// White noise, flicker and random walk; of many channels the white noise alone.
std::vector<NamedCoefficient> key_coefficients(std::size_t channels) {
  constexpr std::size_t most_channels = 3;
  const auto all = named_coefficients.begin();
  return {all, all + (channels > most_channels ? 1 : 3)};
}

std::vector<KeyFigure> key_figures(const NoiseReport& report) {
  std::vector<KeyFigure> figures;
  const std::vector<NamedCoefficient> terms = key_coefficients(report.channels.size());
  for (const ChannelNoise& channel : report.channels) {
    if (!has_coefficients(channel)) {
      figures.push_back({channel.name, channel.analysis ? "too short" : "not analysed"});
      continue;
    }
    const std::string before = report.channels.size() > 1 ? channel.name + ": " : "";
    for (const NamedCoefficient& term : terms) {
      figures.push_back({before + term.name, coefficient_words(channel.analysis->model.*term.figure,
                                                               channel.unit, term.scale)});
    }
  }
  return figures;
}

std::string in_si(double value, const Unit& unit, NoiseScale scale) {
  return significant(value, 4) + ' ' + print_unit(noise_unit(unit, scale));
}

std::string interval_words(const Coefficient& found, const Unit& unit, NoiseScale scale) {
  const ShownUnit shown = shown_unit(unit, scale, found.upper_two_sided_95);
  return fmt::format("{} … {} {}", significant(found.lower_95 * shown.per_si, 3),
                     significant(found.upper_two_sided_95 * shown.per_si, 3), shown.symbol);
}

std::vector<std::string> coefficient_cells(const ChannelNoise& channel,
                                           const NamedCoefficient& term) {
  const Coefficient& found = channel.analysis->model.*term.figure;
  return {term.name, coefficient_words(found, channel.unit, term.scale),
          interval_words(found, channel.unit, term.scale),
          in_si(found.value, channel.unit, term.scale),
          verdict_words(found, channel.analysis->duration_s)};
}

Table coefficients_table(const ChannelNoise& channel) {
  Table table{"Coefficients, two-sided, with what the recording says of each",
              {"Coefficient", "Value", "95 % interval", "In SI", "Verdict"},
              {}};
  const NoiseAnalysis& analysis = *channel.analysis;
  for (const NamedCoefficient& term : named_coefficients) {
    table.rows.push_back(coefficient_cells(channel, term));
  }
  const signal::SpectralFloor& floor = analysis.lines.floor;
  if (floor.one_sided_density > 0.0) {
    const Uncertain level{floor.one_sided_density, floor.std};
    table.rows.push_back(
        {"Spectrum's floor, one-sided", noise_words(level, channel.unit, NoiseScale::density), "",
         in_si(level.value, channel.unit, NoiseScale::density),
         fmt::format("read at {} … {} Hz", compact(floor.low_hz, 3), compact(floor.high_hz, 3))});
  }
  return table;
}

// How the coefficients of noise that is not stationary move.
Table parts_table(const ChannelNoise& channel) {
  Table table{"Not stationary: each part of the recording by itself", {"Part"}, {}};
  for (const NamedCoefficient& term : named_coefficients) table.head.push_back(term.name);
  for (const characterise::NoisePart& part : channel.analysis->parts) {
    std::vector<std::string> row{duration_words(part.start_s) + " … " + duration_words(part.end_s)};
    for (const NamedCoefficient& term : named_coefficients)
      row.push_back(coefficient_words(part.model.*term.figure, channel.unit, term.scale));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table readings_table(const ChannelNoise& channel) {
  const characterise::DeviationCurve& curve = channel.analysis->deviation;
  Table table{"The deviation as data sheets quote it",
              {"At", "Value", compact(100.0 * curve.confidence, 3) + " % limits"},
              {}};
  for (const CurveReading& reading : curve_readings(curve)) {
    const NoiseScale scale = curve_scale(curve.statistic);
    const ShownUnit shown = shown_unit(channel.unit, scale, reading.point.value);
    const auto words = [&](double value) { return significant(value * shown.per_si, 3); };
    const std::string at = duration_words(reading.point.tau_s);
    table.rows.push_back({reading.is_minimum ? at + " (minimum)" : at,
                          words(reading.point.value) + ' ' + shown.symbol,
                          words(reading.point.lower) + " … " + words(reading.point.upper)});
  }
  return table;
}

Table lines_table(const ChannelNoise& channel) {
  Table table{"Lines: power that stands out of the spectrum in a narrow band",
              {"Frequency", "Amplitude of the same sine", "Above the background", "Band",
               "Raises the deviation"},
              {}};
  const NoiseAnalysis& analysis = *channel.analysis;
  for (const signal::SpectralLine& line : analysis.lines.lines) {
    const LineEffect effect = line_effect(analysis, line);
    table.rows.push_back(
        {compact(line.frequency_hz, 5) + " Hz",
         noise_words(Uncertain{line.amplitude, line.amplitude_std}, channel.unit,
                     NoiseScale::level),
         fixed(line.excess_db, 1) + " dB",
         fmt::format("{} … {} Hz", compact(line.low_hz, 4), compact(line.high_hz, 4)),
         fmt::format("by {} % at {}", significant(100.0 * effect.raise, 2),
                     duration_words(effect.tau_s))});
  }
  return table;
}

Table events_table(const ChannelNoise& channel, bool excluded) {
  const NoiseAnalysis& analysis = *channel.analysis;
  Table table{excluded ? "Events, left out of the analysis" : "Events, which the analysis contains",
              {"Kind", "When", "Size", "In standard deviations"},
              {}};
  constexpr std::size_t most_rows = 40;
  for (const signal::Event& event : analysis.events) {
    if (table.rows.size() == most_rows) break;
    table.rows.push_back({event.kind == signal::EventKind::knock ? "Knock" : "Step of level",
                          event_time_words(event, analysis.rate_hz),
                          noise_words(event.size, channel.unit, NoiseScale::level),
                          significant(event.significance, 2)});
  }
  if (analysis.events.size() > most_rows) {
    table.caption += fmt::format(": the first {} of {}; the JSON document has all", most_rows,
                                 count_words(analysis.events.size(), "event"));
  }
  return table;
}

Section channel_section(const ChannelNoise& channel, bool events_excluded) {
  if (!channel.analysis) {
    return {.heading = channel.name, .paragraphs = noise_findings(channel)};
  }
  const NoiseAnalysis& analysis = *channel.analysis;
  Section section{
      .heading = fmt::format("{}: {} at {} Hz", channel.name, duration_words(analysis.duration_s),
                             compact(analysis.rate_hz, 6)),
      .points = noise_findings(channel),
      .figures = {deviation_figure(channel)}};
  if (!analysis.parts.empty()) {
    section.tables.push_back(parts_table(channel));
    section.figures.push_back(parts_figure(channel));
  }
  if (has_coefficients(channel)) section.tables.push_back(coefficients_table(channel));
  if (Table readings = readings_table(channel); !readings.rows.empty())
    section.tables.push_back(std::move(readings));
  if (analysis.spectrum.frequency_hz.size() > 1) {
    section.figures.push_back(spectrum_figure(channel));
  }
  if (!analysis.lines.lines.empty()) section.tables.push_back(lines_table(channel));
  if (!analysis.events.empty()) section.tables.push_back(events_table(channel, events_excluded));
  return section;
}

Section method_section(const NoiseReport& report) {
  Section section{.heading = "How it was computed"};
  section.paragraphs = {
      "The deviation is that of the Allan family, of complete terms only; its limits come from the "
      "equivalent degrees of freedom of the noise found at each averaging time, not from the "
      "number of terms (C. A. Greenhall, W. J. Riley, Uncertainty of stability variances based on "
      "finite differences, PTTI 2003; W. J. Riley, NIST SP 1065, 2008).",
      "The coefficients N, B, K, Q and R are those of IEEE Std 952-1997, annex C. They are fitted "
      "to the spectrum, with lines left out, so that a swaying building or the mains is not taken "
      "for noise of the sensor. A coefficient that the recording can be explained without is "
      "reported as 0, with the bound that the recording puts on it; no slope is forced on the "
      "curve.",
      "Whether the noise is stationary is tested at every octave of averaging times and for every "
      "line, by an analysis of variance of the parts of the recording (after H. Levene, 1960), all "
      "tests together at 0.5 %. Value ± 1.96 of the standard deviation is about the 95 % interval, "
      "on the longer side of it for flicker noise and random walk. A slow change that a sine of a "
      "few periods explains better than noise does is taken out of the coefficients.",
      "N is two-sided, so that it is the deviation at 1 s where all noise is white; the density of "
      "a data sheet is one-sided, √2 N. B is 1/0.664 of the curve's flat part. A minimum of the "
      "curve alone is no bias instability: white noise that meets a random walk has one too."};
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis || channel.analysis->deviation.bias_correction.empty()) continue;
    section.paragraphs.push_back(
        "Correction of the statistic's bias: " + channel.analysis->deviation.bias_correction + ".");
    break;
  }
  return section;
}

std::string title_of(const NoiseReport& report) {
  std::string title;
  for (const std::string& input : report.inputs) {
    title += (title.empty() ? "" : ", ") + file_name(input);
  }
  return title;
}

}  // namespace

Page noise_page(const NoiseReport& report) {
  Page page{.verb = "noise",
            .title = title_of(report),
            .inputs = report.inputs,
            .conclusion = noise_conclusion(report),
            .key_figures = key_figures(report),
            .notes = noise_notes(report)};
  for (const ChannelNoise& channel : report.channels) {
    page.sections.push_back(channel_section(channel, report.events_excluded));
  }
  page.sections.push_back(method_section(report));
  return page;
}

std::string noise_html(const NoiseReport& report) {
  return html(noise_page(report));
}

}  // namespace proofmass::report
