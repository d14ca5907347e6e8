#include "proofmass/estimate/track/strokes.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/track/turns.hpp"

namespace proofmass::estimate {
namespace {

using Motions = std::vector<std::vector<std::size_t>>;

std::vector<double> legs_of(View<double> p, const std::vector<std::size_t>& turns) {
  std::vector<double> legs;
  for (std::size_t i = 1; i < turns.size(); ++i) legs.push_back(p[turns[i]] - p[turns[i - 1]]);
  return legs;
}

Motions motions_of(const TrackSolution& solution) {
  const View<double> p = solution.series.position_m;
  const auto [low, high] = std::minmax_element(p.begin(), p.end());
  const double travel = *high - *low;
  if (!(travel > 0.0)) return {};
  const Motions all = turning_points(p, solution.rests, 0.05 * travel);
  std::vector<double> lengths;
  for (const auto& turns : all)
    for (const double leg : legs_of(p, turns)) lengths.push_back(std::abs(leg));
  const auto usual = median(lengths);
  return usual ? turning_points(p, solution.rests, std::max(0.05 * travel, 0.5 * *usual)) : all;
}

// Uncertainty of differences of positions at the turning points.
class TurnCovariance {
 public:
  TurnCovariance(std::vector<double> row_by_row, std::size_t n, double scale_std)
      : entries_(std::move(row_by_row)), n_(n), scale_std_(scale_std) {}

  [[nodiscard]] double of_difference(std::size_t i, std::size_t j, double length_m) const {
    const double variance = at(i, i) + at(j, j) - 2.0 * at(i, j);
    return std::hypot(std::sqrt(std::max(0.0, variance)), scale_std_ * length_m);
  }
  // Variance of the turning point at i + 1 relative to the mean of its two neighbours.
  [[nodiscard]] double of_mean(std::size_t i, double out_m, double back_m) const {
    const double variance = at(i + 1, i + 1) +
                            0.25 * (at(i, i) + at(i + 2, i + 2) + 2.0 * at(i, i + 2)) -
                            at(i + 1, i) - at(i + 1, i + 2);
    return std::hypot(std::sqrt(std::max(0.0, variance)), scale_std_ * 0.5 * (out_m - back_m));
  }
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return entries_[i * n_ + j]; }

 private:
  std::vector<double> entries_;
  std::size_t n_;
  double scale_std_;
};

// The mean of both ways, or the shorter one if the other is half as long again.
Uncertain length_of(const Uncertain& a, const Uncertain& b, double std_of_mean) {
  const double one = std::abs(a.value), other = std::abs(b.value);
  if (std::max(one, other) <= 1.5 * std::min(one, other)) return {0.5 * (one + other), std_of_mean};
  return one < other ? Uncertain{one, a.std} : Uncertain{other, b.std};
}

Stroke stroke_of(const std::vector<std::size_t>& turns, const LegPair& pair, View<double> time_s) {
  Stroke stroke;
  stroke.first = turns[pair.out];
  stroke.turn = turns[pair.out + 1];
  stroke.last = pair.back ? turns[pair.out + 2] : stroke.turn;
  stroke.start_s = time_s[stroke.first];
  stroke.turn_s = time_s[stroke.turn];
  stroke.end_s = time_s[stroke.last];
  return stroke;
}

// Sum of the signed legs: linear in the positions of the turning points.
double path_std(const Motions& motions,
                const std::vector<std::vector<double>>& legs,
                const TurnCovariance& cov,
                double scale_std) {
  std::vector<double> weight;
  double path = 0.0;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const std::size_t begin = weight.size();
    weight.resize(begin + motions[m].size(), 0.0);
    for (std::size_t i = 0; i < legs[m].size(); ++i) {
      const double sign = legs[m][i] < 0.0 ? -1.0 : 1.0;
      weight[begin + i] -= sign;
      weight[begin + i + 1] += sign;
      path += std::abs(legs[m][i]);
    }
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < weight.size(); ++i)
    for (std::size_t j = 0; j < weight.size(); ++j)
      variance += weight[i] * weight[j] * cov.at(i, j);
  return std::hypot(std::sqrt(std::max(0.0, variance)), scale_std * path);
}

}  // namespace

Strokes find_strokes(const TrackSolution& solution, const PositionCovarianceAt& covariance) {
  Strokes found;
  const Motions motions = motions_of(solution);
  std::vector<std::size_t> turns;
  std::vector<std::vector<double>> legs;
  for (const auto& motion : motions) {
    turns.insert(turns.end(), motion.begin(), motion.end());
    legs.push_back(legs_of(solution.series.position_m, motion));
  }
  const TurnCovariance cov(covariance(turns), turns.size(), solution.scale_std);
  std::size_t begin = 0;
  for (std::size_t m = 0; m < motions.size(); begin += motions[m++].size()) {
    for (const LegPair& pair : pair_legs(legs[m])) {
      Stroke stroke = stroke_of(motions[m], pair, solution.series.time_s);
      const std::size_t i = begin + pair.out;
      const double out = legs[m][pair.out];
      stroke.out_m = {out, cov.of_difference(i, i + 1, out)};
      stroke.length_m = {std::abs(out), stroke.out_m.std};
      if (pair.back) {
        const double back = legs[m][pair.out + 1];
        stroke.back_m = Uncertain{back, cov.of_difference(i + 1, i + 2, back)};
        stroke.length_m = length_of(*stroke.back_m, stroke.out_m, cov.of_mean(i, out, back));
      }
      if (stroke.length_m.value > 2.0 * stroke.length_m.std) found.strokes.push_back(stroke);
    }
  }
  if (!turns.empty()) found.path_std_m = path_std(motions, legs, cov, solution.scale_std);
  return found;
}

}  // namespace proofmass::estimate
