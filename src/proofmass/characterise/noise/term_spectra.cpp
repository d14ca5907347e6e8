#include "proofmass/characterise/noise/term_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::characterise {
namespace {

constexpr double pi = std::numbers::pi;

// |sin(π f τ0 D) / (D sin(π f τ0))|², the means' transfer function.
double mean_transfer(double frequency_hz, const Sampling& sampling) {
  const auto D = static_cast<double>(sampling.block);
  const double phase = pi * frequency_hz / sampling.rate_hz;
  return square(std::sin(D * phase) / (D * std::sin(phase)));
}

double flicker(double frequency_hz, const Sampling& sampling) {
  const auto sampled = [&](double f) {
    return 1.0 / (2.0 * sampling.rate_hz * std::abs(std::sin(pi * f / sampling.rate_hz)));
  };
  if (sampling.block == 1) return sampled(frequency_hz);
  // The aliases fall with the cube of their number.
  constexpr int aliases = 6;
  const auto block = static_cast<int>(sampling.block);
  double sum = 0.0;
  for (int j = -std::min(aliases, (block - 1) / 2); j <= std::min(aliases, block / 2); ++j) {
    const double f = frequency_hz + j / sampling.step_s();
    sum += sampled(f) * mean_transfer(f, sampling);
  }
  return sum;
}

double random_walk(double omega, const Sampling& sampling) {
  const auto D = static_cast<double>(sampling.block);
  const double variance = (2.0 * D * D + 1.0) / (3.0 * D), covariance = (D * D - 1.0) / (6.0 * D);
  return sampling.step_s() / sampling.rate_hz * (variance + 2.0 * covariance * std::cos(omega)) /
         square(2.0 * std::sin(0.5 * omega));
}

// Sums over D neighbours of an exponentially correlated process of variance 1: their variance, and
// their covariance with the next sum; that with the one after is ρ times it.
struct RelaxationSums {
  double phi, one_less_phi, rho, one_less_rho, own, across;
};

RelaxationSums relaxation_sums(double steps_to_relax, double D) {
  RelaxationSums sums{};
  const double decay = 1.0 / steps_to_relax;
  sums.phi = std::exp(-decay);
  sums.one_less_phi = -std::expm1(-decay);
  sums.rho = std::exp(-D * decay);
  sums.one_less_rho = -std::expm1(-D * decay);
  sums.across = sums.phi * square(sums.one_less_rho / sums.one_less_phi);
  sums.own = D * (1.0 + sums.phi) / sums.one_less_phi -
             2.0 * sums.phi * sums.one_less_rho / square(sums.one_less_phi);
  return sums;
}

}  // namespace

double term_density(Term term, double frequency_hz, const Sampling& sampling) {
  PM_EXPECTS(frequency_hz > 0.0 && term != Term::markov);
  const double omega = 2.0 * pi * frequency_hz * sampling.step_s();
  switch (term) {
    case Term::quantisation:
      return square(2.0 * std::sin(0.5 * omega)) / sampling.step_s();
    case Term::flicker:
      return flicker(frequency_hz, sampling);
    case Term::random_walk:
      return random_walk(omega, sampling);
    default:
      return 1.0;
  }
}

double relaxation_density(double time_constant_s, double frequency_hz, const Sampling& sampling) {
  const auto D = static_cast<double>(sampling.block);
  const RelaxationSums sums = relaxation_sums(time_constant_s * sampling.rate_hz, D);
  const double cosine = std::cos(2.0 * pi * frequency_hz * sampling.step_s());
  const double sine = std::sin(pi * frequency_hz * sampling.step_s());
  const double distance = square(sums.one_less_rho) + 4.0 * sums.rho * square(sine);
  const double sum = sums.own + 2.0 * sums.across * (cosine - sums.rho) / distance;
  const double unit_variance = std::max(sum, 0.0) / (D * D) * sampling.step_s();
  // Its density at zero, sampled: τ0 (1 + φ) / (1 − φ).
  return unit_variance * sampling.rate_hz * sums.one_less_phi / (1.0 + sums.phi);
}

double relaxation_allan_variance(double time_constant_s, double m, double rate_hz) {
  const RelaxationSums sums = relaxation_sums(time_constant_s * rate_hz, m);
  const double variance = rate_hz * sums.one_less_phi / (1.0 + sums.phi);
  return variance * (sums.own - sums.across) / (m * m);
}

}  // namespace proofmass::characterise
