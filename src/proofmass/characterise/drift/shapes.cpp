#include "proofmass/characterise/drift/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace proofmass::characterise {

bool is_rival(DriftShape shape) {
  return std::ranges::find(rival_shapes, shape) != rival_shapes.end();
}

bool is_exponential(DriftShape shape) {
  return shape == DriftShape::exponential || shape == DriftShape::exponential_and_line ||
         shape == DriftShape::two_exponentials;
}

std::size_t amplitudes_of(DriftShape shape) {
  if (shape == DriftShape::two_exponentials || shape == DriftShape::sine) return 2;
  return is_exponential(shape) || is_rival(shape) ? 1 : 0;
}

std::size_t scales_of(DriftShape shape) {
  if (shape == DriftShape::square_root) return 0;
  return shape == DriftShape::sine ? 1 : amplitudes_of(shape);
}

double RivalColumn::at(double t_s) const {
  if (shape == DriftShape::sine) {
    const double phase = 2.0 * std::numbers::pi * t_s / scale_s;
    return column == 0 ? std::sin(phase) : std::cos(phase);
  }
  const double t = std::max(t_s, 0.0);
  if (shape == DriftShape::square_root) return std::sqrt(t);
  if (shape == DriftShape::logarithm) return std::log1p(t / scale_s);
  if (shape == DriftShape::hyperbola) return t / (t + scale_s);
  return -std::expm1(-std::sqrt(t / scale_s));
}

double RivalColumn::by_log_scale(double t_s) const {
  if (shape == DriftShape::sine) {
    const double phase = 2.0 * std::numbers::pi * t_s / scale_s;
    return column == 0 ? -phase * std::cos(phase) : phase * std::sin(phase);
  }
  const double t = std::max(t_s, 0.0);
  if (shape == DriftShape::square_root) return 0.0;
  const double share = t / (t + scale_s);
  if (shape == DriftShape::logarithm) return -share;
  if (shape == DriftShape::hyperbola) return -share * (1.0 - share);
  const double root = std::sqrt(t / scale_s);
  return -0.5 * root * std::exp(-root);
}

}  // namespace proofmass::characterise
