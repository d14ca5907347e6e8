#include "proofmass/estimate/track/motion_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace proofmass::estimate {
namespace {

struct Score {
  double log_likelihood = 0.0;
  double closure_variance = 0.0;  // mean over the arrivals at stops
};

Score score(View<InertialEpoch> knots, const InertialNoise& noise, const InertialStart& start) {
  const InertialAxis model{knots, noise};
  FilterState<3> state = inertial_start(start);
  Score score;
  std::size_t arrivals = 0;
  filter(model, {0, model.size()}, Gate{}, state,
         [&](std::size_t k, const StepOf<InertialAxis>& step) {
           for (int i = 0; i < step.count; ++i) {
             const auto& update = step.updates[static_cast<std::size_t>(i)];
             score.log_likelihood -=
                 0.5 * (std::log(2.0 * std::numbers::pi * update.expected) + update.nis());
           }
           if (!knots[k].arrives_at_rest) return;
           score.closure_variance += step.updates[0].expected;
           ++arrivals;
         });
  if (arrivals > 0) score.closure_variance /= static_cast<double>(arrivals);
  return score;
}

// A variance and the logarithm of its prior weight.
struct GridPoint {
  double variance = 0.0, log_weight = 0.0;
};

// Zero three times in four, else normal in the logarithm of the root.
std::vector<GridPoint> grid(double step) {
  constexpr double center = -2.5, std = 0.7, first = -4.5, last = 0.5;
  constexpr double none = 0.75;
  std::vector<GridPoint> points;
  double sum = 0.0;
  for (double log10_root = first; log10_root <= last; log10_root += step) {
    const double off = (log10_root - center) / std;
    points.push_back({std::pow(10.0, 2.0 * log10_root), -0.5 * off * off});
    sum += std::exp(points.back().log_weight);
  }
  for (GridPoint& point : points) point.log_weight += std::log((1.0 - none) / sum);
  points.push_back({0.0, std::log(none)});
  return points;
}

// Grid of the rocking; nine tenths of the weight of zero are on white vibration.
std::vector<GridPoint> lean_grid(double step, double shaking_m2ps3) {
  std::vector<GridPoint> points = grid(step);
  if (shaking_m2ps3 <= 0.0) return points;
  constexpr double white = 0.9;
  points.push_back({shaking_m2ps3, points.back().log_weight + std::log(white)});
  points[points.size() - 2].log_weight += std::log(1.0 - white);
  return points;
}

double outside(double x) {
  return std::erfc(x / std::numbers::sqrt2);
}

}  // namespace

std::vector<InertialEpoch> without_middles(View<InertialEpoch> knots) {
  constexpr std::size_t kept = 3;
  std::vector<InertialEpoch> out(knots.begin(), knots.end());
  // A motion may be a single knot.
  const auto ends_soon_after = [&](std::size_t k) {
    bool ends = k + kept >= knots.size();
    for (std::size_t next = k + 1; next <= k + kept && !ends; ++next) ends = !knots[next].resting;
    return ends;
  };
  std::size_t run = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    run = out[k].resting ? run + 1 : 0;
    const bool ends_soon = ends_soon_after(k);
    if (run > kept && !ends_soon && std::isnan(out[k].position_m)) out[k].level_mps2 = std::nan("");
  }
  std::vector<std::size_t> read;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const bool empty = out[k].resting && std::isnan(out[k].level_mps2) &&
                       std::isnan(out[k].position_m) && k + 1 < out.size() && out[k + 1].resting;
    if (!empty) read.push_back(k);
  }
  return join_epochs(out, read);
}

double mixture_factor(View<double> weight, View<double> variance) {
  double mean = 0.0;
  for (std::size_t i = 0; i < weight.size(); ++i) mean += weight[i] * variance[i];
  double low = 0.5, high = 50.0;
  for (int round = 0; round < 50; ++round) {
    const double middle = 0.5 * (low + high);
    double sum = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i)
      sum += weight[i] * outside(middle * std::sqrt(mean / variance[i]));
    (sum > 0.05 ? low : high) = middle;
  }
  return high;
}

namespace {

/// The score of every point of the grid, plus its log prior weight.
struct GridScores {
  std::vector<double> weight, closure;
  std::vector<std::array<double, 3>> at;
};

GridScores scores_on_grid(View<InertialEpoch> knots,
                          InertialNoise noise,
                          const InertialStart& start,
                          double step) {
  GridScores scores;
  const std::vector<GridPoint> points = grid(step);
  const std::vector<GridPoint> leans = lean_grid(step, noise.shaking_m2ps3);
  for (const GridPoint& walk : points)
    for (const GridPoint& jump : points)
      for (const GridPoint& lean : leans) {
        scores.at.push_back({walk.variance, jump.variance, lean.variance});
        noise.motion_walk_m2ps5 = std::max(walk.variance, noise.rest_walk_m2ps5);
        noise.motion_jump_m2ps4 = jump.variance;
        noise.motion_lean_m2ps3 = lean.variance;
        const Score found = score(knots, noise, start);
        scores.weight.push_back(found.log_likelihood + walk.log_weight + jump.log_weight +
                                lean.log_weight);
        scores.closure.push_back(found.closure_variance);
      }
  return scores;
}

}  // namespace

double log_evidence(View<InertialEpoch> knots,
                    const InertialNoise& noise,
                    const InertialStart& start) {
  const std::vector<double> weight = scores_on_grid(knots, noise, start, 1.0).weight;
  const double best = *std::max_element(weight.begin(), weight.end());
  double sum = 0.0;
  for (const double one : weight) sum += std::exp(one - best);
  return best + std::log(sum);
}

MotionError motion_error(View<InertialEpoch> all_knots,
                         InertialNoise noise,
                         const InertialStart& start) {
  auto [weight, closure, at] = scores_on_grid(without_middles(all_knots), noise, start, 0.5);
  const double best = *std::max_element(weight.begin(), weight.end());
  double sum = 0.0;
  for (double& one : weight) sum += one = std::exp(one - best);
  MotionError posterior;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] /= sum;
    posterior.walk_m2ps5 += weight[i] * std::max(at[i][0], noise.rest_walk_m2ps5);
    posterior.jump_m2ps4 += weight[i] * at[i][1];
    posterior.lean_m2ps3 += weight[i] * at[i][2];
  }
  if (closure.front() > 0.0) posterior.factor_95 = mixture_factor(weight, closure);
  return posterior;
}

std::vector<double> surprise_of_rests(View<InertialEpoch> knots,
                                      const InertialNoise& noise,
                                      const InertialStart& start) {
  std::vector<double> surprise;
  const InertialAxis model{knots, noise};
  FilterState<3> state = inertial_start(start);
  bool level_due = false;
  filter(model, {0, model.size()}, Gate{}, state,
         [&](std::size_t k, const StepOf<InertialAxis>& step) {
           const bool arrives =
               knots[k].arrives_at_rest || (k == 0 && knots[k].velocity_std_mps > 0.0);
           if (arrives) surprise.push_back(k == 0 ? std::nan("") : step.updates[0].nis());
           if (knots[k].resting && level_due && step.count > 0)
             surprise.back() += step.updates[0].nis();
           level_due = arrives;
         });
  return surprise;
}

std::vector<Closure> closures(View<InertialEpoch> knots,
                              const InertialNoise& noise,
                              const InertialStart& start,
                              ConsistencyCheck& check) {
  std::vector<Closure> found;
  const InertialAxis model{knots, noise};
  FilterState<3> state = inertial_start(start);
  double now_s = 0.0, left_s = 0.0;
  std::array<bool, 3> seen{};  // the first reading of a state only says where it starts
  filter(model, {0, model.size()}, Gate{}, state,
         [&](std::size_t k, const StepOf<InertialAxis>& step) {
           now_s += knots[k].dt_s;
           for (int i = 0; i < step.count; ++i) {
             const auto& update = step.updates[static_cast<std::size_t>(i)];
             std::size_t of = 0;
             while (update.h(static_cast<int>(of)) == 0.0) ++of;
             if (of == inertial_axis::velocity_mps && knots[k].arrives_at_rest && seen[of])
               found.push_back({.start_s = left_s,
                                .end_s = now_s,
                                .velocity_mps = -update.innovation,
                                .expected_std_mps = std::sqrt(update.expected)});
             if (seen[of]) check.add(of, update.innovation, update.expected);
             seen[of] = true;
           }
           if (knots[k].resting || k == 0) left_s = now_s;
         });
  return found;
}

}  // namespace proofmass::estimate
