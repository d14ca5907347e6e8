#include "proofmass/estimate/wheel/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

constexpr double least_probability = 0.01;
constexpr double widest_turns = 2.0;  // standard deviation; beyond it there are too many candidates
constexpr std::size_t most_doubts = 4;

using Weights = std::map<int, double>;  // by the turns more than the fit's

/// One component is measured.
void measure(Gaussian<wheel::moving>& state, int which, double value, double std) {
  const Mat<wheel::moving> with = state.cov.col(which);
  const Mat<wheel::moving> gain = with / (with(which) + square(std));
  state.mean += gain * (value - state.mean(which));
  state.cov -= gain * with.transpose();
}

/// The possible turns of one ambiguous interval; empty if there are too many.
Weights weights_of(const WheelDoubt& doubt, const WheelSeries& series) {
  const std::size_t k = doubt.widest;
  Gaussian<wheel::moving> state = doubt.predicted;
  measure(state, wheel::speed, series.speed_radps[k], series.speed_std_radps[k]);
  measure(state, wheel::accel, series.accel_radps2[k], series.accel_std_radps2[k]);
  const double std =
      std::sqrt(std::max(state.cov(wheel::angle, wheel::angle), 0.0)) + series.angle_std_rad[k];
  Weights weights;
  if (!(std < widest_turns * rad_per_turn)) return weights;
  constexpr double reach = 4.0;
  const double off = series.angle_rad[k] - state.mean(wheel::angle);
  const int first = static_cast<int>(std::floor((-off - reach * std) / rad_per_turn));
  const int last = static_cast<int>(std::ceil((-off + reach * std) / rad_per_turn));
  for (int n = first; n <= last; ++n)
    weights[n] = std::exp(-0.5 * square((off + n * rad_per_turn) / std));
  return weights;
}

/// Distribution of the sum of two independent numbers of turns.
Weights sum_of(const Weights& a, const Weights& b) {
  Weights sum;
  for (const auto& [n, weight] : a)
    for (const auto& [more, other] : b) sum[n + more] += weight * other;
  return sum;
}

}  // namespace

std::vector<TurnsCandidate> turns_candidates(const WheelFit& fit) {
  std::vector<TurnsCandidate> all;
  if (fit.doubts.empty() || fit.doubts.size() > most_doubts) return all;
  Weights weights{{0, 1.0}};
  for (const WheelDoubt& doubt : fit.doubts)
    weights = sum_of(weights, weights_of(doubt, fit.series));
  double total = 0.0;
  for (const auto& [n, weight] : weights) total += weight;
  for (const auto& [n, weight] : weights)
    if (weight >= least_probability * total)
      all.push_back({{fit.turns.value + n, fit.turns.std}, weight / total});
  std::ranges::sort(all, std::ranges::greater{}, &TurnsCandidate::probability);
  return all;
}

}  // namespace proofmass::estimate
