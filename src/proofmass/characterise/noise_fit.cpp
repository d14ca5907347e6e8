#include "proofmass/characterise/noise_fit.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "proofmass/characterise/noise/record_needed.hpp"
#include "proofmass/characterise/noise/search.hpp"
#include "proofmass/characterise/noise/slow_wave.hpp"
#include "proofmass/characterise/noise/spectral_groups.hpp"
#include "proofmass/characterise/noise/strength_intervals.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

// With fewer samples the likelihood ratio's intervals are too narrow.
constexpr std::size_t fewest_samples = 100;
constexpr std::size_t fewest_groups = 12;
// For a wave's two amplitudes and its frequency: a random walk or flicker noise gains as much in
// one recording in hundreds; a smaller gain is inconclusive.
constexpr double wave_gain = 30.0;

// A finished search, and its filters.
struct Fitted {
  Search search;
  std::optional<Uncertain> bandwidth_hz = {}, time_constant_s = {};
  Misfit misfit = {};
};

Fitted fitted(GroupedEvidence grouped, double duration_s) {
  Fitted found{.search = begin_search(std::move(grouped))};
  found.bandwidth_hz = find_bandwidth(found.search);
  found.time_constant_s = find_markov(found.search, duration_s);
  found.misfit = weigh_misfit(found.search);
  reconsider_bandwidth(found.search, found.bandwidth_hz);
  reconsider_quantisation(found.search, found.bandwidth_hz);
  eliminate(found.search);
  return found;
}

// Gain of a wave in twice the log-likelihood, with each term that it replaces counted at its own
// required gain.
double gain_of_wave(const Fitted& plain, const Fitted& with_wave, const SlowWave& wave) {
  std::vector<int> active = with_wave.search.active;
  if (!plain.search.markov_s) active = without(std::move(active), column_of_markov);
  const double with = plain.search.likelihood.without_wave(wave)
                          .maximise(active, {}, plain.search.fit.strength)
                          .log_likelihood;
  const double fewer =
      static_cast<double>(plain.search.active.size()) - static_cast<double>(active.size());
  return 2.0 * (with - plain.search.fit.log_likelihood) + needed_gain * fewer;
}

SlowChange described(const SlowWave& wave, double slope_per_s, double duration_s, bool taken_out) {
  constexpr int steps = 500;
  Moments moments;
  for (int k = 0; k <= steps; ++k) {
    const double t = duration_s * k / steps;
    moments.add(wave.at(t) + slope_per_s * t);
  }
  return {1.0 / wave.frequency_hz, moments.max - moments.min, taken_out};
}

bool has_slow_terms(const Search& search) {
  return std::ranges::any_of(search.active, is_slow);
}

// Subtracts a wave from the evidence if it explains that better than noise.
std::optional<SlowChange> take_wave_out(NoiseEvidence evidence, Fitted& found) {
  if (!has_slow_terms(found.search)) return std::nullopt;
  const auto wave = best_slow_wave(found.search, evidence.duration_s);
  if (!wave) return std::nullopt;
  evidence.slow_wave = *wave;
  Fitted other = fitted(group_evidence(evidence), evidence.duration_s);
  if (gain_of_wave(found, other, *wave) < wave_gain) return std::nullopt;
  found = std::move(other);
  return described(*wave, found.search.fit.slope, evidence.duration_s, true);
}

// The interval of slow terms that a wave explains as well is extended to 0.
void doubt_slow_terms(const Fitted& found, NoiseModelFit& model) {
  if (!has_slow_terms(found.search)) return;
  const auto wave = best_slow_wave(found.search, model.duration_s);
  if (!wave) return;
  const auto doubt = [&](int column, Coefficient& coefficient) {
    if (coefficient.verdict != Verdict::identified) return;
    if (!wave_may_stand_for(found.search, *wave, column)) return;
    coefficient.lower_95 = 0.0;
    set_std_of_longer_side(coefficient);
    if (!model.slow_change)
      model.slow_change = described(*wave, found.search.fit.slope, model.duration_s, false);
  };
  doubt(static_cast<int>(Term::flicker), model.flicker);
  doubt(static_cast<int>(Term::random_walk), model.random_walk);
  if (model.markov) doubt(column_of_markov, model.markov->strength);
}

}  // namespace

Result<NoiseModelFit> fit_noise_model(const NoiseEvidence& evidence) {
  GroupedEvidence grouped = group_evidence(evidence);
  if (static_cast<std::size_t>(evidence.duration_s * evidence.spectrum.rate_hz) < fewest_samples ||
      grouped.groups.size() < fewest_groups)
    return Error{
        Errc::too_few_samples,
        fmt::format("a noise model needs {} samples, and 16 in one piece", fewest_samples)};
  Fitted found = fitted(std::move(grouped), evidence.duration_s);
  NoiseModelFit model;
  model.rate_hz = evidence.spectrum.rate_hz;
  model.duration_s = evidence.duration_s;
  model.slow_change = take_wave_out(evidence, found);
  const Search& search = found.search;
  model.ordinates = search.evidence.groups.size();
  model.bandwidth_hz = found.bandwidth_hz;
  model.misfit = found.misfit.relative;
  model.misfit_p = found.misfit.p;

  const auto strength = [&](Term term) {
    return strength_coefficient(search, static_cast<int>(term));
  };
  model.quantisation = strength(Term::quantisation);
  model.white = strength(Term::white);
  model.flicker = strength(Term::flicker);
  model.random_walk = strength(Term::random_walk);
  model.slope_per_s = search.fit.slope;
  model.ramp = model.slow_change
                   ? ramp_coefficient(slope_beside_wave(search, 1.0 / model.slow_change->period_s))
                   : ramp_coefficient(search);
  if (found.time_constant_s) {
    const Coefficient q = strength(Term::markov);
    if (q.verdict == Verdict::identified) model.markov = {q, *found.time_constant_s};
  }
  doubt_slow_terms(found, model);
  set_records_needed(model);
  return model;
}

}  // namespace proofmass::characterise
