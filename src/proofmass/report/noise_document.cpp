#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/report/noise_figures.hpp"
#include "proofmass/report/noise_report.hpp"
#include "proofmass/report/noise_wording.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/sensor/noise_conversions.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoiseModelFit;
using characterise::NoisePart;

constexpr std::size_t sentences_in_conclusion = 3;  // of a single channel

Fields reading_fields(const DeviationPoint& point) {
  const About limit{.why_null = "so few degrees of freedom set no limit at this confidence"};
  return {field::magnitude("tau_s", point.tau_s), field::magnitude("value", point.value),
          field::magnitude("lower", point.lower, limit),
          field::magnitude("upper", point.upper, limit)};
}

Fields point_fields(const DeviationPoint& point, bool knows_lag1) {
  Fields fields = reading_fields(point);
  const auto add = [&](Field one) { fields.push_back(std::move(one)); };
  add(field::magnitude("edf", point.edf,
                       {.meaning = "equivalent degrees of freedom of the variance"}));
  add(field::integer("alpha", point.alpha,
                     {.meaning = "noise type: exponent of f in the spectral density"}));
  if (knows_lag1)
    add(field::integer(
        "alpha_lag1", point.alpha_lag1,
        {.meaning = "noise type by lag-1 autocorrelation", .why_null = "needs 30 averages"}));
  add(field::count("m", point.m, {.meaning = "averaging factor: samples in tau"}));
  add(field::count("terms", point.terms, {.meaning = "squared differences"}));
  add(field::magnitude("uncorrected", point.uncorrected,
                       {.meaning = "before the correction for the bias of the statistic"}));
  return fields;
}

// The minimum is one within the curve, not at an end.
Field minimum(const std::vector<CurveReading>& readings) {
  const auto found = std::ranges::find_if(readings, &CurveReading::is_minimum);
  std::optional<Fields> fields;
  if (found != readings.end()) fields = reading_fields(found->point);
  return field::object_or_null("minimum", std::move(fields),
                               {.meaning = "within the curve",
                                .why_null = "the deviation is lowest at an end of the curve"});
}

std::optional<Fields> deviation_fields(const ChannelNoise& channel) {
  if (!channel.analysis) return std::nullopt;
  const DeviationCurve& curve = channel.analysis->deviation;
  const bool knows_lag1 =
      std::ranges::any_of(curve.points, [](const auto& p) { return p.alpha_lag1.has_value(); });
  std::vector<CurveReading> at = curve_readings(curve);
  Field lowest = minimum(at);
  std::erase_if(at, [](const CurveReading& reading) { return reading.is_minimum; });
  return Fields{
      field::choice("statistic", characterise::name_of(curve.statistic),
                    {"adev", "oadev", "mdev", "tdev", "hdev", "ohdev", "totdev", "mtotdev",
                     "ttotdev", "htotdev", "theo1", "pdev"}),
      field::text("unit", noise_unit(channel.unit, curve_scale(curve.statistic))),
      field::probability("confidence", curve.confidence, {.meaning = "of lower and upper"}),
      field::text("bias_correction", curve.bias_correction,
                  {.meaning = "in words; empty: none was needed"}),
      std::move(lowest),
      field::records("at", at,
                     [](const CurveReading& reading) { return reading_fields(reading.point); },
                     {.meaning = "at 1, 10 and 100 s, where the curve has a point within 3 %"}),
      field::records("points", curve.points,
                     [&](const DeviationPoint& point) { return point_fields(point, knows_lag1); })};
}

Fields coefficient_fields(const Coefficient& found, const std::string& unit) {
  return {
      field::magnitude("value", found.value, {.meaning = "0 where not observable"}),
      field::magnitude("std", found.std,
                       {.meaning = "half of interval_95 over 1.96, for flicker, random_walk and "
                                   "markov its longer side; where not observable upper_95/1.645"}),
      field::text("unit", unit),
      field::numbers("interval_95", std::array{found.lower_95, found.upper_two_sided_95},
                     {.meaning = "central, by likelihood ratio"}),
      field::magnitude("upper_95", found.upper_95, {.meaning = "one-sided 95 % upper limit"}),
      field::choice("verdict", is_identified(found) ? "identified" : "not_observable",
                    {"identified", "not_observable"}),
      field::magnitude(
          "record_needed_s", found.record_needed_s,
          {.meaning = "length of recording that identifies it with 95 % probability, at its "
                      "value, or at upper_95 where it is not observable",
           .why_null = "not even a recording ten thousand times as long would identify it"})};
}

Fields parameter_fields(const NoiseModelFit& model, const Unit& unit) {
  Fields all;
  for (const NamedCoefficient& term : named_coefficients) {
    Fields fields = coefficient_fields(model.*term.figure, noise_unit(unit, term.scale));
    if (term.scale == NoiseScale::density)
      fields.push_back(field::magnitude("one_sided_density",
                                        sensor::one_sided_density(model.white.value),
                                        {.meaning = "as in data sheets: sqrt(2) times the value"}));
    if (term.scale == NoiseScale::slope)
      fields.push_back(
          field::number("slope_per_s", model.slope_per_s,
                        {.meaning = "as fitted, with its sign, also where not observable"}));
    all.push_back(field::object(term.key, std::move(fields)));
  }
  if (!model.markov) return all;
  Fields fields = coefficient_fields(model.markov->strength, noise_unit(unit, NoiseScale::walk));
  fields.push_back(field::measured("time_constant_s", model.markov->time_constant_s, "s"));
  fields.push_back(field::magnitude("std_of_process", model.markov->std_of_process()));
  all.push_back(field::object("markov", std::move(fields),
                              {.meaning = "first-order Markov noise, where the data need it"}));
  return all;
}

Field parameters(const NoiseModelFit& model, const Unit& unit) {
  return field::object(
      "parameters", parameter_fields(model, unit),
      {.meaning = "coefficients of the Allan variance 3 Q^2/tau^2 + N^2/tau + (2 ln2/pi) B^2 + "
                  "K^2 tau/3 + R^2 tau^2/2 (IEEE Std 952-1997, annex C); two-sided"});
}

Field slow_change(const NoiseModelFit& model, const Unit& unit) {
  std::optional<Fields> fields;
  if (model.slow_change)
    fields = Fields{
        field::magnitude("period_s", model.slow_change->period_s),
        field::magnitude("peak_to_peak", model.slow_change->peak_to_peak),
        field::text("unit", noise_unit(unit, NoiseScale::level)),
        field::flag("taken_out", model.slow_change->taken_out,
                    {.meaning = "false: it explains the recording as well as the slow terms whose "
                                "interval reaches 0"})};
  return field::object_or_null(
      "slow_change", std::move(fields),
      {.meaning = "slow deterministic change, like a sine of a few periods or a part of one",
       .why_null = "noise alone explains the recording"});
}

Field misfit(const NoiseModelFit& model) {
  return field::object(
      "misfit",
      {field::magnitude("share_of_density", model.misfit,
                        {.meaning = "rms difference of spectrum and model beyond the scatter of "
                                    "the spectrum"}),
       field::probability("p", model.misfit_p, {.meaning = "probability of as much by chance"}),
       field::count("groups", model.ordinates, {.meaning = "of spectral values in the fit"})});
}

// The square of a coefficient times a factor.
Field squared(const char* key,
              const Coefficient& found,
              double factor,
              const std::string& unit,
              About about) {
  std::optional<Uncertain> square;
  if (is_identified(found))
    square = Uncertain{factor * found.value * found.value, factor * 2.0 * found.value * found.std};
  return field::measured(key, square, unit, std::move(about));
}

Field markov_for_flicker(const NoiseAnalysis& analysis, const Unit& unit) {
  constexpr double maximum_at = 1.89;  // of a Markov process's Allan variance, in time constants
  std::optional<Fields> fields;
  if (const auto flat_s = flicker_tau_s(analysis)) {
    const sensor::FirstOrderMarkov process =
        sensor::markov_of_flicker({analysis.model.flicker.value, *flat_s / maximum_at});
    fields = Fields{field::magnitude("time_constant_s", process.time_constant_s),
                    field::magnitude("psd", process.psd_m2ps5),
                    field::text("psd_unit", squared_unit(unit, NoiseScale::walk)),
                    field::magnitude("variance", process.variance_m2ps4()),
                    field::text("variance_unit", squared_unit(unit, NoiseScale::level))};
  }
  return field::object_or_null(
      "flicker_as_markov", std::move(fields),
      {.meaning = "first-order Markov process with the same flat part (Farrell et al., IEEE "
                  "Control Systems Magazine 42(6), 2022)",
       .why_null = "no flicker noise is identified"});
}

Field filter(const NoiseAnalysis& analysis, const Unit& unit) {
  const NoiseModelFit& model = analysis.model;
  std::optional<double> bandwidth_hz;
  if (model.bandwidth_hz) bandwidth_hz = model.bandwidth_hz->value;
  const double of_density = sensor::sample_variance_m2ps4({1.0, analysis.rate_hz, bandwidth_hz});
  const char* no_white = "white noise is not identified";
  return field::object(
      "filter",
      {squared("sample_variance", model.white, of_density, squared_unit(unit, NoiseScale::level),
               {.meaning = "variance of the white noise of a sample: R of a filter",
                .why_null = no_white}),
       squared("white_psd", model.white, 1.0, squared_unit(unit, NoiseScale::density),
               {.meaning = "N^2, two-sided", .why_null = no_white}),
       squared("bias_psd", model.random_walk, 1.0, squared_unit(unit, NoiseScale::walk),
               {.meaning = "K^2: density of the white noise that drives the bias random walk",
                .why_null = "no random walk is identified; parameters.random_walk.upper_95 is its "
                            "limit"}),
       markov_for_flicker(analysis, unit)},
      {.meaning = "for estimators"});
}

// What a recording too short for coefficients does not have.
Fields model_fields(const ChannelNoise& channel) {
  if (has_coefficients(channel)) {
    const NoiseModelFit& model = channel.analysis->model;
    return {parameters(model, channel.unit), slow_change(model, channel.unit),
            field::measured("bandwidth_hz", model.bandwidth_hz, "Hz",
                            {.meaning = "-3 dB of a one-pole filter on the white noise",
                             .why_null = "the spectrum does not roll off below half the rate"}),
            misfit(model), filter(*channel.analysis, channel.unit)};
  }
  const About about{.why_null = channel.analysis ? "the recording is too short for coefficients"
                                                 : why_not_analysed(channel)};
  Fields fields;
  for (const char* key : {"parameters", "slow_change"})
    fields.push_back(field::object_or_null(key, std::nullopt, about));
  fields.push_back(field::measured("bandwidth_hz", std::nullopt, "Hz", about));
  for (const char* key : {"misfit", "filter"})
    fields.push_back(field::object_or_null(key, std::nullopt, about));
  return fields;
}

// Means over intervals that are even on a log scale; an interval is all line or no line, so that
// lines keep their position and their power.
struct ThinnedSpectrum {
  std::vector<double> frequency_hz, one_sided_psd;
};

ThinnedSpectrum thinned_spectrum(const NoiseAnalysis& analysis) {
  constexpr double most_points = 500.0;
  const signal::Spectrum& spectrum = analysis.spectrum;
  const std::vector<bool>& in_line = analysis.lines.in_line;
  // The end bins are half as wide: theirs are not densities like the others.
  const std::size_t bins = spectrum.frequency_hz.size() - 1;
  const auto marked = [&](std::size_t k) { return k < in_line.size() && in_line[k]; };
  const double ratio =
      std::pow(static_cast<double>(std::max<std::size_t>(bins, 2)), 1.0 / most_points);
  ThinnedSpectrum out;
  for (std::size_t k = 1; k < bins;) {
    const double limit = spectrum.frequency_hz[k] * ratio;
    double f = 0.0, psd = 0.0;
    std::size_t end = k;
    do {
      f += spectrum.frequency_hz[end];
      psd += spectrum.one_sided_psd[end];
      ++end;
    } while (end < bins && spectrum.frequency_hz[end] < limit && marked(end) == marked(k));
    const auto n = static_cast<double>(end - k);
    out.frequency_hz.push_back(f / n);
    out.one_sided_psd.push_back(psd / n);
    k = end;
  }
  return out;
}

std::optional<Fields> spectrum_of(const ChannelNoise& channel) {
  if (!has_spectrum(channel)) return std::nullopt;
  const signal::Spectrum& found = channel.analysis->spectrum;
  const ThinnedSpectrum thin = thinned_spectrum(*channel.analysis);
  const auto segment = static_cast<double>(std::max<std::size_t>(found.segment, 1));
  return Fields{field::choice("window", "hann", {"hann"}),
                field::count("segment", found.segment, {.meaning = "samples"}),
                field::count("averaged", found.averaged, {.meaning = "segments"}),
                field::magnitude("resolution_hz", found.rate_hz / segment),
                field::magnitude("noise_bandwidth_hz", found.window_bandwidth_hz),
                field::magnitude("edf_per_bin", found.edf_per_bin),
                field::text("unit", squared_unit(channel.unit, NoiseScale::density)),
                field::numbers("frequency_hz", thin.frequency_hz),
                field::numbers("one_sided_psd", thin.one_sided_psd)};
}

Fields spectrum_fields(const ChannelNoise& channel) {
  std::optional<Uncertain> floor;
  if (channel.analysis && channel.analysis->lines.floor.one_sided_density > 0.0)
    floor = Uncertain{channel.analysis->lines.floor.one_sided_density,
                      channel.analysis->lines.floor.std};
  const auto why = [&](const char* reason) {
    return channel.analysis ? reason : why_not_analysed(channel);
  };
  const std::string density = noise_unit(channel.unit, NoiseScale::density);
  const std::string why_no_floor = why("no part of the spectrum is flat");
  return {
      field::measured("spectrum_floor", floor, density,
                      {.meaning = "lowest level that the spectrum keeps for an octave; one-sided, "
                                  "as densities in data sheets",
                       .why_null = why_no_floor}),
      field::measured("spectrum_floor_two_sided", scaled(floor, 1.0 / std::numbers::sqrt2), density,
                      {.meaning = "comparable with white and with the deviation at 1 s",
                       .why_null = why_no_floor}),
      field::object_or_null("spectrum", spectrum_of(channel),
                            {.meaning = "by Welch's method; means over intervals even in log f",
                             .why_null = why("the recording is too short for one")})};
}

Field lines(const ChannelNoise& channel) {
  const auto fields_of = [&](const signal::SpectralLine& line) -> Fields {
    const LineEffect effect = line_effect(*channel.analysis, line);
    return {field::magnitude("frequency_hz", line.frequency_hz),
            field::magnitude("amplitude", line.amplitude, {.meaning = "of a sine of equal power"}),
            field::magnitude("amplitude_std", line.amplitude_std),
            field::text("unit", noise_unit(channel.unit, NoiseScale::level)),
            field::magnitude("low_hz", line.low_hz),
            field::magnitude("high_hz", line.high_hz),
            field::number("excess_db", line.excess_db),
            field::object("raises_deviation",
                          {field::magnitude("tau_s", effect.tau_s),
                           field::magnitude("fraction", effect.raise)},
                          {.meaning = "largest increase of the deviation, and where"})};
  };
  return field::records(
      "lines",
      channel.analysis ? channel.analysis->lines.lines : std::vector<signal::SpectralLine>{},
      fields_of);
}

Field events(const ChannelNoise& channel) {
  const auto fields_of = [&](const signal::Event& event) -> Fields {
    const double rate_hz = channel.analysis->rate_hz;
    return {field::choice("kind", event.kind == signal::EventKind::knock ? "knock" : "step",
                          {"knock", "step"}),
            field::number("start_s", static_cast<double>(event.first) / rate_hz),
            field::number("end_s", static_cast<double>(event.last) / rate_hz),
            field::number("size", event.size),
            field::text("unit", noise_unit(channel.unit, NoiseScale::level)),
            field::magnitude("significance", event.significance,
                             {.meaning = "in standard deviations of the noise"})};
  };
  return field::records("events",
                        channel.analysis ? channel.analysis->events : std::vector<signal::Event>{},
                        fields_of);
}

Field stationarity(const ChannelNoise& channel) {
  std::optional<Fields> fields;
  if (channel.analysis && channel.analysis->stationarity.tested) {
    const characterise::Stationarity& test = channel.analysis->stationarity;
    const auto part_fields = [&](const NoisePart& part) -> Fields {
      return {field::number("start_s", part.start_s), field::number("end_s", part.end_s),
              parameters(part.model, channel.unit)};
    };
    fields = Fields{
        field::choice("verdict", test.stationary ? "stationary" : "not_stationary",
                      {"stationary", "not_stationary"}),
        field::probability("p", test.p, {.meaning = "of all tests together"}),
        field::magnitude("averaging_s",
                         test.line_hz ? std::nullopt : std::optional(test.averaging_s),
                         {.meaning = "averaging time at which the level varies most",
                          .why_null = "the line at line_hz varies most"}),
        field::magnitude("line_hz", test.line_hz,
                         {.meaning = "line whose level varies most",
                          .why_null = "the level at averaging_s varies more than any line"}),
        field::numbers("relative_level", test.relative_level,
                       {.meaning = "level there in equal parts of the recording, over its mean"}),
        field::records("parts", channel.analysis->parts, part_fields,
                       {.meaning = "where not stationary: each eighth (or quarter) by itself; "
                                   "empty for a recording larger than --memory"})};
  }
  return field::object_or_null(
      "stationarity", std::move(fields),
      {.meaning = "whether the noise is constant; lines are not tested in a recording larger than "
                  "--memory",
       .why_null = channel.analysis ? "the recording is too short for the test"
                                    : why_not_analysed(channel)});
}

Fields record_fields(const ChannelNoise& channel) {
  const NoiseAnalysis none;
  const NoiseAnalysis& analysis = channel.analysis ? *channel.analysis : none;
  Fields fields{field::count("samples", analysis.samples, {.meaning = "missing ones included"}),
                field::count("missing", analysis.missing),
                field::magnitude("rate_hz", analysis.rate_hz),
                field::magnitude("duration_s", analysis.duration_s),
                field::number("mean", analysis.mean),
                field::magnitude("lsb", analysis.lsb,
                                 {.meaning = "converter step",
                                  .why_null = "the values show no step of a converter"})};
  if (!channel.analysis)
    for (Field& one : fields) one = field::without_value(std::move(one), why_not_analysed(channel));
  return fields;
}

Field temperature(const ChannelNoise& channel) {
  const TemperatureEffect& effect = *channel.temperature;
  return field::object(
      "temperature",
      {field::text("channel", effect.channel),
       field::measured("coefficient", effect.coefficient,
                       noise_unit(channel.unit, NoiseScale::level) + "/" + effect.per)},
      {.meaning = "removed linear dependence, with --temperature"});
}

Fields channel_fields(const ChannelNoise& channel) {
  Fields fields{field::text("name", channel.name),
                field::text("unit", noise_unit(channel.unit, NoiseScale::level),
                            {.meaning = "of the series analysed: SI, counts, or 1 where unknown"}),
                rest_field(channel.rest), stationarity(channel),
                field::object_or_null("deviation", deviation_fields(channel),
                                      {.why_null = why_not_analysed(channel)})};
  append(fields, model_fields(channel));
  append(fields, spectrum_fields(channel));
  append(fields, {lines(channel), events(channel)});
  append(fields, record_fields(channel));
  if (channel.temperature) fields.push_back(temperature(channel));
  return fields;
}

// The report's own, then each channel's with its name; a refusal is bad.
std::vector<Note> all_notes(const NoiseReport& report) {
  std::vector<Note> notes = report.notes;
  for (const ChannelNoise& channel : report.channels) {
    if (!channel.analysis) {
      notes.push_back({Severity::bad, channel.name + ": " + why_not_analysed(channel)});
      continue;
    }
    if (const std::string moving = motion_sentence(channel.rest, "noise"); !moving.empty())
      notes.push_back({Severity::bad, channel.name + ": " + moving});
    for (const Note& note : channel.analysis->notes)
      notes.push_back({note.severity, channel.name + ": " + note.text});
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

// White noise, flicker and random walk; of many channels the white noise alone.
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

// The deviation as data sheets quote it; all of a curve of few points, which somebody has chosen or
// a short record has.
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
    table.rows.push_back({event.kind == signal::EventKind::knock ? "Knock" : "Step",
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

// The sentences of a single channel begin in the conclusion.
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
      .fields = {field::records("channels", report.channels, channel_fields),
                 field::flag("events_excluded", report.events_excluded), field::notes(notes)},
      .failure = why_no_channel(report.channels)};
  for (const ChannelNoise& channel : report.channels)
    document.page.sections.push_back(channel_section(report, channel));
  document.page.sections.push_back(method_section(report));
  return document;
}

}  // namespace proofmass::report
