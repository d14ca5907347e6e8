#include "proofmass/simulate/rig/bias_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace proofmass::simulate {
namespace {

constexpr std::size_t processes = 14;
constexpr double shortest_s = 0.02, ratio = 4.0;

double time_constant_s(std::size_t j) {
  return shortest_s * std::pow(ratio, static_cast<double>(j));
}

/// Mean over d and final value of a process of unit variance that starts at 0; x = d/T.
struct Stretch {
  double memory;      ///< e^(−x)
  double mean_share;  ///< weight of the start in the mean, (1 − e^(−x))/x
  double mean_variance, end_variance, covariance;
};

Stretch stretch(double x) {
  const double lost = -std::expm1(-x);  // 1 − e^(−x)
  // ∫∫ of e^(−|s−t|) minus the part explained by the start; for small x the differences cancel.
  const double mean_variance =
      x < 1e-2 ? x * (2.0 / 3.0 - x / 2.0) : (2.0 * (x - lost) - lost * lost) / (x * x);
  return {1.0 - lost, lost / x, mean_variance, lost * (2.0 - lost), lost * lost / x};
}

}  // namespace

BiasNoise::BiasNoise(const Strength& strength, const Random& random)
    : std_(strength.flicker_mps2 * std::sqrt(std::log(ratio) * std::numbers::inv_pi)),
      walk_rate_(strength.walk_mps2_rts),
      draws_(random) {
  if (std_ == 0.0) return;
  markov_.resize(processes);
  steps_.resize(processes);
  for (double& x : markov_) x = std_ * draws_.normal();
}

double BiasNoise::value_mps2() const {
  double sum = walk_;
  for (const double x : markov_) sum += x;
  return sum;
}

void BiasNoise::pass(double dt_s) {
  constexpr double rounding = 1e-9;
  if (std::abs(dt_s - step_s_) > rounding * dt_s) {
    step_s_ = dt_s;
    for (std::size_t j = 0; j < steps_.size(); ++j) {
      const double lost = -std::expm1(-dt_s / time_constant_s(j));
      steps_[j] = {lost, std_ * std::sqrt(lost * (2.0 - lost))};
    }
  }
  for (std::size_t j = 0; j < markov_.size(); ++j)
    markov_[j] += steps_[j].draw * draws_.normal() - steps_[j].lost * markov_[j];
  if (walk_rate_ != 0.0) walk_ += walk_rate_ * std::sqrt(dt_s) * draws_.normal();
}

double BiasNoise::mean_over(double dt_s) {
  double mean = 0.0;
  for (std::size_t j = 0; j < markov_.size(); ++j) {
    const Stretch s = stretch(dt_s / time_constant_s(j));
    const double end_draw = draws_.normal(), mean_draw = draws_.normal();
    const double end_std = std::sqrt(s.end_variance);
    const double common = end_std > 0.0 ? s.covariance / end_std : 0.0;
    mean += markov_[j] * s.mean_share +
            std_ * (common * end_draw +
                    std::sqrt(std::max(0.0, s.mean_variance - common * common)) * mean_draw);
    markov_[j] = markov_[j] * s.memory + std_ * end_std * end_draw;
  }
  if (walk_rate_ == 0.0) return mean;
  // Brownian motion over dt: variance dt at the end, dt/3 of the mean, covariance dt/2.
  const double end_draw = draws_.normal(), mean_draw = draws_.normal();
  const double step = walk_rate_ * std::sqrt(dt_s);
  mean += walk_ + step * (0.5 * end_draw + std::sqrt(1.0 / 12.0) * mean_draw);
  walk_ += step * end_draw;
  return mean;
}

}  // namespace proofmass::simulate
