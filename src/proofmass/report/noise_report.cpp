#include "proofmass/report/noise_report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <set>

#include "proofmass/report/noise_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using Rows = std::vector<std::vector<std::string>>;

std::string heading(const ChannelNoise& channel) {
  const NoiseAnalysis& analysis = *channel.analysis;
  std::string text =
      fmt::format("{}: {} at {} Hz, {}", channel.name, duration_words(analysis.duration_s),
                  compact(analysis.rate_hz, 6), count_words(analysis.samples, "sample"));
  if (analysis.missing > 0) text += ", " + grouped(analysis.missing) + " of them missing";
  return text + "\n";
}

Rows coefficient_rows(const ChannelNoise& channel) {
  const NoiseAnalysis& analysis = *channel.analysis;
  Rows rows;
  if (!has_coefficients(channel)) return rows;
  for (const NamedCoefficient& term : named_coefficients) {
    const characterise::Coefficient& coefficient = analysis.model.*term.figure;
    rows.push_back({term.name, coefficient_words(coefficient, channel.unit, term.scale),
                    verdict_words(coefficient, channel.analysis->duration_s)});
  }
  const signal::SpectralFloor& floor = analysis.lines.floor;
  if (floor.one_sided_density > 0.0) {
    rows.push_back({"Spectrum's floor",
                    noise_words(Uncertain{floor.one_sided_density, floor.std}, channel.unit,
                                NoiseScale::density),
                    fmt::format("one-sided, {} … {} Hz; to compare with N divide by √2",
                                compact(floor.low_hz, 3), compact(floor.high_hz, 3))});
  }
  return rows;
}

// How the coefficients of noise that is not stationary move.
Rows part_rows(const ChannelNoise& channel) {
  const auto& parts = channel.analysis->parts;
  Rows rows;
  if (parts.empty()) return rows;
  rows.push_back({"Part of the recording", "N", "B", "K"});
  for (const characterise::NoisePart& part : parts) {
    std::vector<std::string> row{duration_words(part.start_s) + " … " + duration_words(part.end_s)};
    for (std::size_t k = 0; k < 3; ++k) {
      const NamedCoefficient& term = named_coefficients[k];
      row.push_back(coefficient_words(part.model.*term.figure, channel.unit, term.scale));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

// The deviation at 1, 10 and 100 s and its minimum, as data sheets give them.
Rows reading_rows(const ChannelNoise& channel) {
  const DeviationCurve& curve = channel.analysis->deviation;
  const NoiseScale scale = curve_scale(curve.statistic);
  Rows rows;
  const auto add = [&](const std::string& name, const DeviationPoint& point) {
    const ShownUnit shown = shown_unit(channel.unit, scale, point.value);
    const auto words = [&](double value) { return significant(value * shown.per_si, 3); };
    rows.push_back({name, words(point.value) + ' ' + shown.symbol,
                    fmt::format("{} % limits {} … {}", compact(100.0 * curve.confidence, 3),
                                words(point.lower), words(point.upper))});
  };
  for (const CurveReading& reading : curve_readings(curve)) {
    if (reading.is_minimum)
      add(fmt::format("Minimum of the curve, at {}", duration_words(reading.point.tau_s)),
          reading.point);
    else
      add(fmt::format("Deviation at {}", duration_words(reading.point.tau_s)), reading.point);
  }
  return rows;
}

Rows line_rows(const ChannelNoise& channel) {
  Rows rows;
  for (const signal::SpectralLine& line : channel.analysis->lines.lines) {
    rows.push_back({"Line", compact(line.frequency_hz, 5) + " Hz",
                    noise_words(Uncertain{line.amplitude, line.amplitude_std}, channel.unit,
                                NoiseScale::level),
                    fmt::format("{} dB above the background", fixed(line.excess_db, 1))});
  }
  return rows;
}

Rows event_rows(const ChannelNoise& channel) {
  constexpr std::size_t most_rows = 10;
  const NoiseAnalysis& analysis = *channel.analysis;
  Rows rows;
  for (const signal::Event& event : analysis.events) {
    if (rows.size() == most_rows) {
      rows.push_back({"…", count_words(analysis.events.size(), "event") + " in all"});
      break;
    }
    rows.push_back({event.kind == signal::EventKind::knock ? "Knock" : "Step",
                    event_time_words(event, analysis.rate_hz),
                    noise_words(event.size, channel.unit, NoiseScale::level)});
  }
  return rows;
}

// Of a curve of few points, which somebody has chosen or a short record has.
Rows point_rows(const ChannelNoise& channel) {
  constexpr std::size_t few = 12;
  const DeviationCurve& curve = channel.analysis->deviation;
  const NoiseScale scale = curve_scale(curve.statistic);
  Rows rows;
  if (curve.points.empty() || curve.points.size() > few) return rows;
  rows.push_back({"τ", std::string(characterise::title_of(curve.statistic)),
                  compact(100.0 * curve.confidence, 3) + " % limits"});
  for (const DeviationPoint& point : curve.points) {
    const ShownUnit shown = shown_unit(channel.unit, scale, point.value);
    const auto words = [&](double value) { return significant(value * shown.per_si, 4); };
    rows.push_back({compact(point.tau_s, 6) + " s", words(point.value) + ' ' + shown.symbol,
                    words(point.lower) + " … " + words(point.upper)});
  }
  return rows;
}

std::string channel_text(const ChannelNoise& channel) {
  if (!channel.analysis)
    return fmt::format("{}: not analysed: {}\n", channel.name, channel.refused);
  std::string text = heading(channel);
  for (const std::string& sentence : doubts_of(channel)) text += "  " + sentence + '\n';
  for (const Rows& rows : {coefficient_rows(channel), part_rows(channel), reading_rows(channel),
                           point_rows(channel), line_rows(channel), event_rows(channel)}) {
    if (!rows.empty()) text += '\n' + aligned(rows);
  }
  text += '\n';
  const std::vector<std::string> sentences = noise_findings(channel);
  for (std::size_t k = doubts_of(channel).size(); k < sentences.size(); ++k)
    text += "  " + sentences[k] + '\n';
  return text;
}

const DeviationPoint* point_at(const DeviationCurve& curve, double tau_s) {
  const auto at = std::ranges::lower_bound(curve.points, tau_s, {}, &DeviationPoint::tau_s);
  return at != curve.points.end() && at->tau_s == tau_s ? &*at : nullptr;
}

void add_columns(const ChannelNoise& channel, const std::vector<double>& taus, Recording& table) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values, lower, upper;
  for (const double tau_s : taus) {
    const DeviationPoint* point = point_at(channel.analysis->deviation, tau_s);
    values.push_back(point != nullptr ? point->value : none);
    lower.push_back(point != nullptr ? point->lower : none);
    upper.push_back(point != nullptr ? point->upper : none);
  }
  Unit unit = channel.unit;
  unit.symbol = noise_unit(unit, curve_scale(channel.analysis->deviation.statistic));
  table.channels.push_back({channel.name, unit, std::move(values)});
  table.channels.push_back({channel.name + "_lower", unit, std::move(lower)});
  table.channels.push_back({channel.name + "_upper", unit, std::move(upper)});
}

}  // namespace

std::string noise_conclusion(const NoiseReport& report) {
  std::string text;
  if (report.channels.size() > 1) {
    for (const std::string& sentence : common_doubts(report)) text += sentence + ' ';
  }
  if (report.channels.size() == 1) {
    const std::vector<std::string> sentences = noise_findings(report.channels.front());
    for (std::size_t k = 0; k < std::min<std::size_t>(3, sentences.size()); ++k) {
      text += (text.empty() ? "" : " ") + sentences[k];
    }
    return text;
  }
  for (const ChannelNoise& channel : report.channels) {
    text += (&channel == &report.channels.front() ? "White noise: " : "; ") + channel.name + ' ';
    text += has_coefficients(channel) ? coefficient_words(channel.analysis->model.white,
                                                          channel.unit, NoiseScale::density)
            : channel.analysis        ? "not determined"
                                      : "not analysed";
  }
  return text + ".";
}

std::vector<Note> noise_notes(const NoiseReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis) {
      notes.push_back({Severity::bad, channel.name + ": not analysed: " + channel.refused});
      continue;
    }
    if (const std::string moving = motion_sentence(channel.rest, "noise"); !moving.empty())
      notes.push_back({Severity::bad, channel.name + ": " + moving});
    for (const Note& note : channel.analysis->notes) {
      notes.push_back({note.severity, channel.name + ": " + note.text});
    }
  }
  return notes;
}

std::string noise_text(const NoiseReport& report) {
  std::string text;
  for (const ChannelNoise& channel : report.channels) {
    text += (text.empty() ? "" : "\n") + channel_text(channel);
  }
  return text;
}

Recording noise_series(const NoiseReport& report) {
  std::set<double> all;
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis) continue;
    for (const DeviationPoint& point : channel.analysis->deviation.points) all.insert(point.tau_s);
  }
  const std::vector<double> taus(all.begin(), all.end());
  Recording table;
  table.source = "proofmass noise";
  table.format = "series";
  table.channels.push_back({"tau_s", {}, taus});
  for (const ChannelNoise& channel : report.channels) {
    if (channel.analysis) add_columns(channel, taus, table);
  }
  return table;
}

}  // namespace proofmass::report
