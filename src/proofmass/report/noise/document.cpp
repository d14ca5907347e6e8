#include <algorithm>
#include <fmt/format.h>

#include "proofmass/report/noise/fields.hpp"
#include "proofmass/report/noise/figures.hpp"
#include "proofmass/report/noise/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoisePart;

constexpr std::size_t sentences_in_conclusion = 3;  // for a single channel

// The report's notes, then those of each channel with its name; a refused channel is Severity::bad.
std::vector<Note> all_notes(const NoiseReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis) {
      notes.push_back({Severity::bad, channel.name + ": " + why_not_analysed(channel)});
      continue;
    }
    if (const std::string moving = motion_sentence(channel.rest, "noise"); !moving.empty())
      notes.push_back({Severity::bad, channel.name + ": " + moving});
    for (const Note& note : channel.analysis->notes) notes.push_back(note.at(channel.name));
  }
  return notes;
}

std::string conclusion(const NoiseReport& report) {
  std::string text;
  if (report.channels.size() == 1) {
    const std::vector<std::string> sentences = noise_findings(report.channels.front());
    for (std::size_t k = 0; k < std::min(sentences_in_conclusion, sentences.size()); ++k)
      text += (text.empty() ? "" : " ") + sentences[k];
    return text;
  }
  for (const std::string& sentence : common_doubts(report)) text += sentence + ' ';
  for (const ChannelNoise& channel : report.channels) {
    text += (&channel == &report.channels.front() ? "White noise: " : "; ") + channel.name + ' ';
    text += has_coefficients(channel) ? coefficient_words(channel.analysis->model.white,
                                                          channel.unit, NoiseScale::density)
            : channel.analysis        ? std::string(absent)
                                      : "not analysed";
  }
  return text + ".";
}

// White noise, flicker and random walk; for many channels the white noise only.
std::vector<KeyFigure> figures_of(const NoiseReport& report) {
  constexpr std::size_t most_channels = 3;
  const std::size_t shown = report.channels.size() > most_channels ? 1 : 3;
  std::vector<KeyFigure> figures;
  for (const ChannelNoise& channel : report.channels) {
    if (!has_coefficients(channel)) {
      figures.push_back({channel.name, channel.analysis ? "too short" : "not analysed"});
      continue;
    }
    const std::string before = report.channels.size() > 1 ? channel.name + ": " : "";
    for (std::size_t k = 0; k < shown; ++k) {
      const NamedCoefficient& term = named_coefficients[k];
      figures.push_back({before + term.name, coefficient_words(channel.analysis->model.*term.figure,
                                                               channel.unit, term.scale)});
    }
  }
  return figures;
}

Table coefficients_table(const ChannelNoise& channel) {
  Table table{"Coefficients, two-sided", {"Coefficient", "Value", "Verdict"}, {}};
  const NoiseAnalysis& analysis = *channel.analysis;
  for (const NamedCoefficient& term : named_coefficients) {
    const Coefficient& found = analysis.model.*term.figure;
    table.rows.push_back({term.name, coefficient_words(found, channel.unit, term.scale),
                          verdict_words(found, analysis.duration_s)});
  }
  const signal::SpectralFloor& floor = analysis.lines.floor;
  if (floor.one_sided_density > 0.0)
    table.rows.push_back({"Spectral floor",
                          noise_words(Uncertain{floor.one_sided_density, floor.std}, channel.unit,
                                      NoiseScale::density),
                          fmt::format("one-sided, {} … {} Hz; divide by √2 to compare with N",
                                      compact(floor.low_hz, 3), compact(floor.high_hz, 3))});
  return table;
}

Table intervals_table(const ChannelNoise& channel) {
  Table table{"The same in SI, with 95 % intervals", {"Coefficient", "Value", "95 % interval"}, {}};
  table.page_only = true;
  for (const NamedCoefficient& term : named_coefficients) {
    const Coefficient& found = channel.analysis->model.*term.figure;
    const std::string unit = print_unit(noise_unit(channel.unit, term.scale));
    table.rows.push_back({term.name, fmt::format("{} {}", significant(found.value, 4), unit),
                          fmt::format("{} … {} {}", significant(found.lower_95, 3),
                                      significant(found.upper_two_sided_95, 3), unit)});
  }
  return table;
}

Table parts_table(const ChannelNoise& channel) {
  Table table{"Not stationary: each part of the recording by itself", {"Part", "N", "B", "K"}, {}};
  for (const NoisePart& part : channel.analysis->parts) {
    std::vector<std::string> row{duration_words(part.start_s) + " … " + duration_words(part.end_s)};
    for (std::size_t k = 0; k < 3; ++k) {
      const NamedCoefficient& term = named_coefficients[k];
      row.push_back(coefficient_words(part.model.*term.figure, channel.unit, term.scale));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// The deviation at the averaging times of data sheets; all points of a short curve, whose times
// were chosen by the user or limited by a short record.
Table deviation_table(const ChannelNoise& channel) {
  constexpr std::size_t few = 12;
  const DeviationCurve& curve = channel.analysis->deviation;
  const NoiseScale scale = curve_scale(curve.statistic);
  Table table{"",
              {"τ", std::string(characterise::title_of(curve.statistic)),
               compact(100.0 * curve.confidence, 3) + " % limits"},
              {}};
  const auto add = [&](const DeviationPoint& point, const char* remark) {
    const ShownUnit shown = shown_unit(channel.unit, scale, point.value);
    const auto words = [&](double value) { return significant(value * shown.per_si, 3); };
    table.rows.push_back({compact(point.tau_s, 6) + " s" + remark,
                          words(point.value) + ' ' + shown.symbol,
                          words(point.lower) + " … " + words(point.upper)});
  };
  if (curve.points.size() <= few) {
    for (const DeviationPoint& point : curve.points) add(point, "");
    return table;
  }
  for (const CurveReading& reading : curve_readings(curve))
    add(reading.point, reading.is_minimum ? " (minimum)" : "");
  return table;
}

Table lines_table(const ChannelNoise& channel) {
  Table table{"Spectral lines",
              {"Frequency", "Amplitude", "Above the background", "Band", "Raises the deviation"},
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
  Table table{excluded ? "Events, excluded from the analysis" : "Events, included in the analysis",
              {"Kind", "Time", "Size", "In standard deviations"},
              {}};
  table.long_list = true;
  for (const signal::Event& event : channel.analysis->events)
    table.rows.push_back({event.kind == signal::EventKind::outlier ? "Outlier" : "Step",
                          event_time_words(event, channel.analysis->rate_hz),
                          noise_words(event.size, channel.unit, NoiseScale::level),
                          significant(event.significance, 2)});
  return table;
}

std::string data_words(const NoiseAnalysis& analysis) {
  return fmt::format(
      "{} at {} Hz, {}{}.", count_words(analysis.samples, "sample"), compact(analysis.rate_hz, 6),
      duration_words(analysis.duration_s),
      analysis.missing > 0 ? ", " + grouped(analysis.missing) + " of them missing" : "");
}

// For a single channel the first sentences are in the conclusion.
Section channel_section(const NoiseReport& report, const ChannelNoise& channel) {
  Section section{.heading = channel.name, .points = noise_findings(channel), .on_terminal = true};
  if (report.channels.size() == 1)
    section.points.erase(
        section.points.begin(),
        section.points.begin() +
            std::min<std::ptrdiff_t>(sentences_in_conclusion, std::ssize(section.points)));
  if (!channel.analysis) return section;
  const NoiseAnalysis& analysis = *channel.analysis;
  section.paragraphs = {data_words(analysis)};
  const auto add_table = [&](Table table) {
    if (!table.rows.empty()) section.tables.push_back(std::move(table));
  };
  section.figures = {[&] { return deviation_figure(channel); }};
  add_table(parts_table(channel));
  if (!analysis.parts.empty()) section.figures.push_back([&] { return parts_figure(channel); });
  if (has_coefficients(channel)) {
    add_table(coefficients_table(channel));
    add_table(intervals_table(channel));
  }
  add_table(deviation_table(channel));
  if (has_spectrum(channel)) section.figures.push_back([&] { return spectrum_figure(channel); });
  add_table(lines_table(channel));
  add_table(events_table(channel, report.events_excluded));
  return section;
}

Section method_section(const NoiseReport& report) {
  Section section{.heading = "How it was computed"};
  section.paragraphs = {
      "The deviation uses complete terms of the Allan family only; its confidence limits follow "
      "from the equivalent degrees of freedom of the noise identified at each averaging time "
      "(C. A. Greenhall, W. J. Riley, Uncertainty of stability variances based on finite "
      "differences, PTTI 2003; W. J. Riley, NIST SP 1065, 2008).",
      "The coefficients N, B, K, Q and R are those of IEEE Std 952-1997, annex C. They are fitted "
      "to the spectrum without its lines, so that building sway or mains interference is not "
      "attributed to the sensor. A coefficient that the data do not require is 0, with an upper "
      "limit.",
      "Stationarity is tested at every octave of averaging time and for every line, by an analysis "
      "of variance over parts of the recording (after H. Levene, 1960), at a joint level of 0.5 %. "
      "Value ± 1.96 standard deviations is about the 95 % interval, for flicker noise and random "
      "walk on its longer side. A slow change that a sine of a few periods explains better than "
      "noise is removed before the fit.",
      "N is two-sided: it equals the deviation at 1 s where all noise is white. The one-sided "
      "density of a data sheet is √2 N. B is 1/0.664 of the flat part of the curve. A minimum of "
      "the curve is not in itself bias instability: white noise with a random walk has one too."};
  const auto corrected = std::ranges::find_if(report.channels, [](const ChannelNoise& channel) {
    return channel.analysis && !channel.analysis->deviation.bias_correction.empty();
  });
  if (corrected != report.channels.end())
    section.paragraphs.push_back(
        "Bias of the statistic: " + corrected->analysis->deviation.bias_correction + ".");
  return section;
}

}  // namespace

Document describe(const NoiseReport& report) {
  const std::vector<Note> notes = all_notes(report);
  Document document{
      .page = {.verb = "noise",
               .title = file_names(report.inputs),
               .inputs = report.inputs,
               .conclusion = conclusion(report),
               .key_figures = figures_of(report),
               .notes = notes},
      .fields = {field::records("channels", report.channels, noise_fields),
                 field::flag("events_excluded", report.events_excluded), field::notes(notes)},
      .failure = why_no_channel(report.channels)};
  for (const ChannelNoise& channel : report.channels)
    document.page.sections.push_back(channel_section(report, channel));
  document.page.sections.push_back(method_section(report));
  return document;
}

}  // namespace proofmass::report
