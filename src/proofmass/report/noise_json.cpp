#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "proofmass/report/json.hpp"
#include "proofmass/report/noise_nulls.hpp"
#include "proofmass/report/noise_report.hpp"
#include "proofmass/report/noise_wording.hpp"
#include "proofmass/sensor/noise_conversions.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoiseModelFit;

constexpr std::size_t most_spectral_points = 500;

Value optional(const std::optional<double>& figure) {
  return figure ? Value(*figure) : Value();
}

Value reading_of(const DeviationPoint& point) {
  return Object{{"tau_s", point.tau_s},
                {"value", point.value},
                {"lower", point.lower},
                {"upper", point.upper}};
}

// Within the curve; one at its end is no minimum of the deviation.
Value minimum(const DeviationCurve& curve) {
  for (const CurveReading& reading : curve_readings(curve))
    if (reading.is_minimum) return reading_of(reading.point);
  return nullptr;
}

Value deviation(const DeviationCurve& curve, const Unit& unit) {
  const bool lag1 = knows_lag1(curve);
  Array points;
  for (const DeviationPoint& point : curve.points) {
    Object item{{"tau_s", point.tau_s}, {"value", point.value}, {"lower", point.lower},
                {"upper", point.upper}, {"edf", point.edf},     {"alpha", point.alpha}};
    if (lag1) item.push_back({"alpha_lag1", point.alpha_lag1 ? Value(*point.alpha_lag1) : Value()});
    item.push_back({"m", point.m});
    item.push_back({"terms", point.terms});
    item.push_back({"uncorrected", point.uncorrected});
    points.emplace_back(std::move(item));
  }
  Array at;
  for (const CurveReading& reading : curve_readings(curve))
    if (!reading.is_minimum) at.push_back(reading_of(reading.point));
  return Object{{"statistic", characterise::name_of(curve.statistic)},
                {"unit", noise_unit(unit, curve_scale(curve.statistic))},
                {"confidence", curve.confidence},
                {"bias_correction", curve.bias_correction},
                {"minimum", minimum(curve)},
                {"at", std::move(at)},
                {"points", std::move(points)}};
}

Object coefficient(const Coefficient& found, const std::string& unit) {
  return {{"value", found.value},
          {"std", found.std},
          {"unit", unit},
          {"interval_95", Array{found.lower_95, found.upper_two_sided_95}},
          {"upper_95", found.upper_95},
          {"verdict", is_identified(found) ? "identified" : "not_observable"},
          {"record_needed_s", optional(found.record_needed_s)}};
}

Object parameters(const NoiseModelFit& model, const Unit& unit) {
  Object all;
  for (const NamedCoefficient& term : named_coefficients) {
    Object item = coefficient(model.*term.figure, noise_unit(unit, term.scale));
    if (term.scale == NoiseScale::density) {
      item.push_back({"one_sided_density", sensor::one_sided_density(model.white.value)});
    }
    if (term.scale == NoiseScale::slope) item.push_back({"slope_per_s", model.slope_per_s});
    all.push_back({term.key, std::move(item)});
  }
  if (model.markov) {
    Object item = coefficient(model.markov->strength, noise_unit(unit, NoiseScale::walk));
    item.push_back({"time_constant_s", quantity(model.markov->time_constant_s, "s")});
    item.push_back({"std_of_process", model.markov->std_of_process()});
    all.push_back({"markov", std::move(item)});
  }
  return all;
}

// Means over stretches that are even on a log scale; a stretch is all line or no line, so that
// lines keep their place and their power.
struct ThinnedSpectrum {
  Array frequency_hz, one_sided_psd;
};

ThinnedSpectrum thinned_spectrum(const NoiseAnalysis& analysis) {
  const signal::Spectrum& spectrum = analysis.spectrum;
  const std::vector<bool>& in_line = analysis.lines.in_line;
  // The ends stand for half a band each, and are no densities like the others.
  const std::size_t bins = std::max<std::size_t>(spectrum.frequency_hz.size(), 1) - 1;
  const auto marked = [&](std::size_t k) { return k < in_line.size() && in_line[k]; };
  const double ratio =
      std::pow(static_cast<double>(std::max<std::size_t>(bins, 2)), 1.0 / most_spectral_points);
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
    out.frequency_hz.emplace_back(f / n);
    out.one_sided_psd.emplace_back(psd / n);
    k = end;
  }
  return out;
}

Value spectrum(const NoiseAnalysis& analysis, const Unit& unit) {
  const signal::Spectrum& found = analysis.spectrum;
  ThinnedSpectrum thin = thinned_spectrum(analysis);
  const auto segment = static_cast<double>(std::max<std::size_t>(found.segment, 1));
  return Object{{"window", "hann"},
                {"segment", found.segment},
                {"averaged", found.averaged},
                {"resolution_hz", found.rate_hz / segment},
                {"noise_bandwidth_hz", found.window_bandwidth_hz},
                {"edf_per_bin", found.edf_per_bin},
                {"unit", squared_unit(unit, NoiseScale::density)},
                {"frequency_hz", std::move(thin.frequency_hz)},
                {"one_sided_psd", std::move(thin.one_sided_psd)}};
}

Array lines(const NoiseAnalysis& analysis, const Unit& unit) {
  Array items;
  for (const signal::SpectralLine& line : analysis.lines.lines) {
    const LineEffect effect = line_effect(analysis, line);
    items.push_back(
        Object{{"frequency_hz", line.frequency_hz},
               {"amplitude", line.amplitude},
               {"amplitude_std", line.amplitude_std},
               {"unit", noise_unit(unit, NoiseScale::level)},
               {"low_hz", line.low_hz},
               {"high_hz", line.high_hz},
               {"excess_db", line.excess_db},
               {"raises_deviation", Object{{"tau_s", effect.tau_s}, {"fraction", effect.raise}}}});
  }
  return items;
}

Array events(const NoiseAnalysis& analysis, const Unit& unit) {
  Array items;
  for (const signal::Event& event : analysis.events) {
    items.push_back(Object{{"kind", event.kind == signal::EventKind::knock ? "knock" : "step"},
                           {"start_s", static_cast<double>(event.first) / analysis.rate_hz},
                           {"end_s", static_cast<double>(event.last) / analysis.rate_hz},
                           {"size", event.size},
                           {"unit", noise_unit(unit, NoiseScale::level)},
                           {"significance", event.significance}});
  }
  return items;
}

// The square of a coefficient times a factor: what an estimator takes.
Value squared(const Coefficient& found, double factor, const std::string& unit) {
  if (!is_identified(found)) return nullptr;
  return quantity(
      Uncertain{factor * found.value * found.value, factor * 2.0 * found.value * found.std}, unit);
}

Value markov_for_flicker(const NoiseAnalysis& analysis, const Unit& unit) {
  const auto flat_s = flicker_tau_s(analysis);
  if (!flat_s) return nullptr;
  constexpr double maximum_at = 1.89;  // of a Markov process's Allan variance, in time constants
  const sensor::FirstOrderMarkov process =
      sensor::markov_of_flicker({analysis.model.flicker.value, *flat_s / maximum_at});
  return Object{{"time_constant_s", process.time_constant_s},
                {"psd", process.psd_m2ps5},
                {"psd_unit", squared_unit(unit, NoiseScale::walk)},
                {"variance", process.variance_m2ps4()},
                {"variance_unit", squared_unit(unit, NoiseScale::level)}};
}

Value filter(const NoiseAnalysis& analysis, const Unit& unit) {
  const NoiseModelFit& model = analysis.model;
  std::optional<double> bandwidth_hz;
  if (model.bandwidth_hz) bandwidth_hz = model.bandwidth_hz->value;
  const double of_density = sensor::sample_variance_m2ps4({1.0, analysis.rate_hz, bandwidth_hz});
  return Object{
      {"sample_variance", squared(model.white, of_density, squared_unit(unit, NoiseScale::level))},
      {"white_psd", squared(model.white, 1.0, squared_unit(unit, NoiseScale::density))},
      {"bias_psd", squared(model.random_walk, 1.0, squared_unit(unit, NoiseScale::walk))},
      {"flicker_as_markov", markov_for_flicker(analysis, unit)}};
}

Value temperature(const ChannelNoise& channel) {
  const TemperatureEffect& effect = *channel.temperature;
  return Object{
      {"channel", effect.channel},
      {"coefficient", quantity(effect.coefficient,
                               noise_unit(channel.unit, NoiseScale::level) + "/" + effect.per)}};
}

Value slow_change(const NoiseModelFit& model, const Unit& unit) {
  if (!model.slow_change) return nullptr;
  return Object{{"period_s", model.slow_change->period_s},
                {"peak_to_peak", model.slow_change->peak_to_peak},
                {"unit", noise_unit(unit, NoiseScale::level)},
                {"taken_out", model.slow_change->taken_out}};
}

void add_coefficients(const ChannelNoise& found, Object& item) {
  const NoiseModelFit& model = found.analysis->model;
  item.push_back({"parameters", parameters(model, found.unit)});
  item.push_back({"slow_change", slow_change(model, found.unit)});
  item.push_back({"bandwidth_hz", quantity(model.bandwidth_hz, "Hz")});
  item.push_back({"misfit", Object{{"share_of_density", model.misfit},
                                   {"p", model.misfit_p},
                                   {"groups", model.ordinates}}});
  item.push_back({"filter", filter(*found.analysis, found.unit)});
}

Value stationarity(const ChannelNoise& found) {
  const characterise::Stationarity& test = found.analysis->stationarity;
  if (!test.tested) return nullptr;
  Array levels, parts;
  for (const double level : test.relative_level) levels.emplace_back(level);
  for (const characterise::NoisePart& part : found.analysis->parts) {
    parts.push_back(Object{{"start_s", part.start_s},
                           {"end_s", part.end_s},
                           {"parameters", parameters(part.model, found.unit)}});
  }
  return Object{{"verdict", test.stationary ? "stationary" : "not_stationary"},
                {"p", test.p},
                {"averaging_s", test.line_hz ? Value() : Value(test.averaging_s)},
                {"line_hz", optional(test.line_hz)},
                {"relative_level", std::move(levels)},
                {"parts", std::move(parts)}};
}

void add_spectrum(const ChannelNoise& found, Object& item) {
  const auto floor = one_sided_floor(*found.analysis);
  const std::string density = noise_unit(found.unit, NoiseScale::density);
  item.push_back({"spectrum_floor", quantity(floor, density)});
  item.push_back(
      {"spectrum_floor_two_sided", quantity(scaled(floor, 1.0 / std::numbers::sqrt2), density)});
  const bool any = found.analysis->spectrum.frequency_hz.size() > 1;
  item.push_back({"spectrum", any ? spectrum(*found.analysis, found.unit) : Value()});
}

Value channel(const ChannelNoise& found) {
  Object item{{"name", found.name}, {"unit", noise_unit(found.unit, NoiseScale::level)}};
  const auto add = [&](const char* key, Value value) { item.push_back({key, std::move(value)}); };
  const auto add_nulls = [&](const auto& keys) {
    for (const char* key : keys) add(key, nullptr);
  };
  add("rest", rest_value(found.rest));
  add("stationarity", found.analysis ? stationarity(found) : Value());
  add("deviation", found.analysis ? deviation(found.analysis->deviation, found.unit) : Value());
  if (has_coefficients(found))
    add_coefficients(found, item);
  else
    add_nulls(coefficient_keys);
  if (found.analysis)
    add_spectrum(found, item);
  else
    add_nulls(spectrum_keys);
  add("lines", found.analysis ? lines(*found.analysis, found.unit) : Array{});
  add("events", found.analysis ? events(*found.analysis, found.unit) : Array{});
  if (found.analysis) {
    const NoiseAnalysis& analysis = *found.analysis;
    add("samples", analysis.samples);
    add("missing", analysis.missing);
    add("rate_hz", analysis.rate_hz);
    add("duration_s", analysis.duration_s);
    add("mean", analysis.mean);
    add("lsb", optional(analysis.lsb));
  } else {
    add_nulls(record_keys);
  }
  if (found.temperature) add("temperature", temperature(found));
  return item;
}

}  // namespace

std::string noise_json(const NoiseReport& report) {
  const std::vector<Note> notes = noise_notes(report);
  std::vector<std::string> warnings = texts(notes, Severity::warning);
  Array channels;
  for (const ChannelNoise& found : report.channels) {
    channels.push_back(channel(found));
    for (std::string& reason : null_reasons(found)) warnings.push_back(std::move(reason));
  }
  return to_json({"noise", report.inputs, warnings},
                 {{"channels", std::move(channels)},
                  {"events_excluded", report.events_excluded},
                  {"notes", array_of(texts(notes, Severity::info))}});
}

}  // namespace proofmass::report
