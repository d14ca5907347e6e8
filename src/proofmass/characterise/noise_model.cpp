#include "proofmass/characterise/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/characterise/noise/term_spectra.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

constexpr double pi = std::numbers::pi;

// σ²(τ) τ / S(0) of an exponentially correlated process of time constant T. Source: IEEE Std
// 952-1997, annex C; by its series for τ ≪ T, to avoid cancellation.
double relaxation_share(double tau_s, double time_constant_s) {
  const double x = tau_s / time_constant_s;
  if (x < 1e-3) return x * x / 3.0 * (1.0 - 0.75 * x);
  return 1.0 - (3.0 - 4.0 * std::exp(-x) + std::exp(-2.0 * x)) / (2.0 * x);
}

}  // namespace

double MarkovNoise::std_of_process() const {
  return strength.value * std::sqrt(0.5 * time_constant_s.value);
}

double NoiseModelFit::allan_variance(Term term, double tau_s) const {
  switch (term) {
    case Term::quantisation:
      return 3.0 * square(quantisation.value / tau_s);
    case Term::white: {
      if (!bandwidth_hz) return square(white.value) / tau_s;
      return square(white.value) * relaxation_allan_variance(1.0 / (2.0 * pi * bandwidth_hz->value),
                                                             std::max(1.0, tau_s * rate_hz),
                                                             rate_hz);
    }
    case Term::flicker:
      return 2.0 * std::numbers::ln2 / pi * square(flicker.value);
    case Term::random_walk:
      if (random_walk.value == 0.0) return 0.0;  // an empty model has no rate either
      // For a random walk in steps of 1/rate: within one sample it is not yet a random walk.
      return square(random_walk.value) * (tau_s / 3.0 + 1.0 / (6.0 * tau_s * rate_hz * rate_hz));
    case Term::markov:
      break;
  }
  if (!markov) return 0.0;
  const double T = markov->time_constant_s.value;
  return square(markov->strength.value * T) / tau_s * relaxation_share(tau_s, T);
}

double NoiseModelFit::ramp_allan_variance(double tau_s) const {
  return 0.5 * square(ramp.value * tau_s);
}

double NoiseModelFit::allan_variance(double tau_s) const {
  double sum = ramp_allan_variance(tau_s);
  for (std::size_t k = 0; k < term_count; ++k) sum += allan_variance(static_cast<Term>(k), tau_s);
  return sum;
}

double NoiseModelFit::shape(Term term, double frequency_hz) const {
  const Sampling sampling{rate_hz, 1};
  if (term == Term::white && bandwidth_hz)
    return relaxation_density(1.0 / (2.0 * pi * bandwidth_hz->value), frequency_hz, sampling);
  if (term != Term::markov) return term_density(term, frequency_hz, sampling);
  PM_EXPECTS(markov.has_value());
  const double T = markov->time_constant_s.value;
  return T * T * relaxation_density(T, frequency_hz, sampling);
}

double NoiseModelFit::density(double frequency_hz) const {
  double sum = 0.0;
  const auto add = [&](Term term, const Coefficient& coefficient) {
    if (coefficient.value > 0.0) sum += square(coefficient.value) * shape(term, frequency_hz);
  };
  add(Term::quantisation, quantisation);
  add(Term::white, white);
  add(Term::flicker, flicker);
  add(Term::random_walk, random_walk);
  if (markov) add(Term::markov, markov->strength);
  return sum;
}

double sine_allan_variance(double amplitude, double frequency_hz, double tau_s) {
  const double phase = pi * frequency_hz * tau_s;
  return square(amplitude * square(std::sin(phase)) / phase);
}

}  // namespace proofmass::characterise
