#include "proofmass/characterise/noise_fit.hpp"

#include <fmt/format.h>

#include "proofmass/characterise/noise_search.hpp"
#include "proofmass/characterise/record_needed.hpp"
#include "proofmass/characterise/spectral_groups.hpp"
#include "proofmass/characterise/strength_intervals.hpp"

namespace proofmass::characterise {
namespace {

// Of fewer samples the likelihood ratio's intervals are too narrow.
constexpr std::size_t fewest_samples = 100;
constexpr std::size_t fewest_groups = 12;

}  // namespace

Result<NoiseModelFit> fit_noise_model(const NoiseEvidence& evidence) {
  GroupedEvidence grouped = group_evidence(evidence);
  if (static_cast<std::size_t>(evidence.duration_s * evidence.spectrum.rate_hz) < fewest_samples ||
      grouped.groups.size() < fewest_groups)
    return Error{
        Errc::too_few_samples,
        fmt::format("a noise model needs {} samples, and 16 in one piece", fewest_samples)};
  Search search = begin_search(std::move(grouped));
  NoiseModelFit model;
  model.rate_hz = evidence.spectrum.rate_hz;
  model.duration_s = evidence.duration_s;
  model.ordinates = search.evidence.groups.size();
  model.bandwidth_hz = find_bandwidth(search);
  const auto time_constant = find_markov(search, evidence.duration_s);
  const Misfit misfit = weigh_misfit(search);
  reconsider_bandwidth(search, model.bandwidth_hz);
  reconsider_quantisation(search, model.bandwidth_hz);
  model.misfit = misfit.relative;
  model.misfit_p = misfit.p;
  eliminate(search);

  const auto found = [&](Term term) {
    return strength_coefficient(search, static_cast<int>(term));
  };
  model.quantisation = found(Term::quantisation);
  model.white = found(Term::white);
  model.flicker = found(Term::flicker);
  model.random_walk = found(Term::random_walk);
  model.slope_per_s = search.fit.slope;
  model.ramp = ramp_coefficient(search);
  if (time_constant) {
    const Coefficient strength = found(Term::markov);
    if (strength.verdict == Verdict::identified) model.markov = {strength, *time_constant};
  }
  set_records_needed(model);
  return model;
}

}  // namespace proofmass::characterise
