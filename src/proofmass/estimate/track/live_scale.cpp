#include "proofmass/estimate/track/live_scale.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/estimate/track/motion_noise.hpp"

namespace proofmass::estimate {

MotionScale::MotionScale() {
  constexpr double first = -4.0, step = 0.25, std = 1.4;
  for (std::size_t i = 0; i < points; ++i) {
    const double log10_scale = first + step * static_cast<double>(i);
    value_[i] = std::pow(10.0, log10_scale);
    log_weight_[i] = -0.5 * log10_scale * log10_scale / (std * std);
  }
  settle(0.0, 1.0);
}

void MotionScale::learn(double velocity_mps, double known, double usual) {
  for (std::size_t i = 0; i < points; ++i) {
    const double variance = known + value_[i] * usual;
    log_weight_[i] -= 0.5 * (std::log(variance) + velocity_mps * velocity_mps / variance);
  }
  settle(known, usual);
}

void MotionScale::settle(double known, double usual) {
  const double best = *std::ranges::max_element(log_weight_);
  double sum = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    log_weight_[i] -= best;
    sum += weight_[i] = std::exp(log_weight_[i]);
    variance_[i] = known + value_[i] * usual;
  }
  double log_middle = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    mean += (weight_[i] /= sum) * variance_[i];
    log_middle += weight_[i] * std::log(value_[i]);
  }
  middle_ = std::exp(log_middle);
  const double width = mixture_factor(weight_, variance_) / 1.96;
  scale_ = std::max((width * width * mean - known) / usual, value_.front());
}

}  // namespace proofmass::estimate
