#include "proofmass/estimate/tune/interval.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"

namespace proofmass::estimate {
namespace {

constexpr double two_sided_95 = 1.959964;  // of the normal distribution

}  // namespace

TuneProblem without(const TuneProblem& problem, std::size_t unknown, double value) {
  TuneProblem rest = problem;
  rest.set(unknown, value);
  rest.unknowns.erase(rest.unknowns.begin() + static_cast<std::ptrdiff_t>(unknown));
  return rest;
}

std::optional<double> profile_limit(const TuneProblem& at_maximum, const ProfileSide& side) {
  // A noise that vanishes can be larger by that factor, a time constant cannot.
  const bool noise = at_maximum.parameter(side.unknown).role != TuneRole::time_constant;
  const double farthest = noise ? 45.0 : 12.0;
  constexpr double close_enough = 5e-3;
  constexpr int most_steps = 40;
  const double best = at_maximum.log_likelihood(), wanted = std::sqrt(side.drop);
  const double at = std::log(at_maximum.value(side.unknown)), sign = side.upwards ? 1.0 : -1.0;
  double inner = 0.0, inner_root = 0.0, outer = 0.0, outer_root = 0.0;  // outer 0: none yet
  double distance = std::clamp(wanted * side.log_std, 1e-6, 2.0);
  for (int k = 0; k < most_steps; ++k) {
    TuneProblem tried = without(at_maximum, side.unknown, std::exp(at + sign * distance));
    const double loss = 2.0 * (best - maximise(tried, false).log_likelihood);
    const double root = std::sqrt(std::max(loss, 0.0));
    if (std::abs(root - wanted) < close_enough * wanted) break;
    (root < wanted ? inner : outer) = distance;
    (root < wanted ? inner_root : outer_root) = root;
    if (outer == 0.0) {
      if (distance >= farthest) return std::nullopt;
      const double factor = root > 0.0 ? std::clamp(wanted / root, 1.2, 3.0) : 3.0;
      distance = std::min(farthest, distance * factor);
    } else {
      // The secant, but never into the outer tenths of the bracket.
      const double share =
          std::isfinite(outer_root) ? (wanted - inner_root) / (outer_root - inner_root) : 0.5;
      distance = inner + std::clamp(share, 0.1, 0.9) * (outer - inner);
    }
  }
  return std::exp(at + sign * distance);
}

TuneInterval interval_95(const TuneProblem& at_maximum, std::size_t unknown, double log_std) {
  constexpr double narrow = 0.1;
  const double value = at_maximum.value(unknown);
  if (log_std < narrow) {
    return {value * std::exp(-two_sided_95 * log_std), value * std::exp(two_sided_95 * log_std)};
  }
  const double drop = chi_square_quantile(0.95, 1.0);
  ProfileSide side{.unknown = unknown, .upwards = false, .drop = drop, .log_std = log_std};
  TuneInterval interval;
  interval.lower = profile_limit(at_maximum, side);
  side.upwards = true;
  interval.upper = profile_limit(at_maximum, side);
  return interval;
}

}  // namespace proofmass::estimate
