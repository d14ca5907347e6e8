#include "proofmass/report/noise_nulls.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "proofmass/report/noise_wording.hpp"

namespace proofmass::report {
namespace {

using characterise::Coefficient;
using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoiseModelFit;

// Names of coefficients that fulfil something, "random_walk, ramp".
template <class Predicate>
std::string names_where(const NoiseModelFit& model, Predicate holds) {
  std::string names;
  for (const NamedCoefficient& term : named_coefficients) {
    if (holds(model.*term.figure)) names += (names.empty() ? "" : ", ") + std::string(term.key);
  }
  if (model.markov && holds(model.markov->strength)) names += names.empty() ? "markov" : ", markov";
  return names;
}

template <class Keys>
void add_names(const Keys& keys, std::string& names) {
  for (const char* key : keys) names += (names.empty() ? "" : ", ") + std::string(key);
}

using Say = std::function<void(const std::string&)>;

void explain_coefficients(const NoiseAnalysis& analysis, const Say& say) {
  const NoiseModelFit& model = analysis.model;
  const std::string endless =
      names_where(model, [](const Coefficient& c) { return !c.record_needed_s; });
  if (!endless.empty()) {
    say("record_needed_s: null for " + endless +
        ": not even ten thousand times this recording would do");
  }
  if (!model.slow_change) say("slow_change: null: nothing but noise is needed to explain it");
  if (!model.bandwidth_hz) {
    say("bandwidth_hz: null: the spectrum does not roll off below half the rate");
  }
  if (!is_identified(model.white)) {
    say("filter: sample_variance and white_psd: null: white noise is not identified");
  }
  if (!is_identified(model.random_walk)) {
    say("filter: bias_psd: null: no random walk is identified; upper_95 bounds it");
  }
  if (!flicker_tau_s(analysis)) {
    say("filter: flicker_as_markov: null: no flicker noise is identified");
  }
}

bool is_bounded(const DeviationPoint& point) {
  return std::isfinite(point.upper);
}

// Why a channel's nulls are nulls.
void explain_nulls(const ChannelNoise& found, const Say& say) {
  std::string lacking;
  if (!found.analysis) {
    lacking = "rest, stationarity, deviation";
    add_names(coefficient_keys, lacking);
    add_names(spectrum_keys, lacking);
    add_names(record_keys, lacking);
    return say("null for " + lacking + ", because it was not analysed: " + found.refused);
  }
  const NoiseAnalysis& analysis = *found.analysis;
  if (const std::string reason = rest_null_reason(found.rest); !reason.empty()) say(reason);
  if (!analysis.stationarity.tested)
    say("stationarity: null: not tested: too short");
  else if (!analysis.stationarity.line_hz)
    say("stationarity: line_hz: null: not a line departs most, but the band at averaging_s");
  else
    say("stationarity: averaging_s: null: the line at line_hz departs most");
  if (std::ranges::none_of(curve_readings(analysis.deviation), &CurveReading::is_minimum))
    say("deviation: minimum: null: the curve has none but at its ends");
  if (has_coefficients(found)) {
    explain_coefficients(analysis, say);
  } else {
    add_names(coefficient_keys, lacking);
    say("null for " + lacking + ": the recording is too short for coefficients");
  }
  if (!one_sided_floor(analysis)) {
    say("spectrum_floor and spectrum_floor_two_sided: null: no stretch of the spectrum is flat");
  }
  if (analysis.spectrum.frequency_hz.size() < 2) {
    say("spectrum: null: the recording is too short for one");
  }
  if (!analysis.lsb) say("lsb: null: the values show no step of a converter");
  const auto is_open = [](const DeviationPoint& point) { return !point.alpha_lag1; };
  if (knows_lag1(analysis.deviation) && std::ranges::any_of(analysis.deviation.points, is_open)) {
    say("alpha_lag1: null where fewer than 30 averages are left to tell it from");
  }
  if (!std::ranges::all_of(analysis.deviation.points, is_bounded)) {
    say("upper: null where so few degrees of freedom bound nothing at this confidence");
  }
}

}  // namespace

std::optional<Uncertain> one_sided_floor(const NoiseAnalysis& analysis) {
  const signal::SpectralFloor& floor = analysis.lines.floor;
  if (!(floor.one_sided_density > 0.0)) return std::nullopt;
  return Uncertain{floor.one_sided_density, floor.std};
}

bool knows_lag1(const DeviationCurve& curve) {
  return std::ranges::any_of(curve.points, [](const auto& p) { return p.alpha_lag1.has_value(); });
}

std::vector<std::string> null_reasons(const ChannelNoise& channel) {
  std::vector<std::string> reasons;
  explain_nulls(channel, [&](const std::string& sentence) {
    reasons.push_back(channel.name + ": " + sentence);
  });
  return reasons;
}

}  // namespace proofmass::report
