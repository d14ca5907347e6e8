#include "proofmass/acquire/clock/clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace proofmass::acquire {
namespace {

constexpr std::size_t most_points = 4096;
constexpr double least_span_s = 30.0;
constexpr std::size_t least_points = 16;

}  // namespace

void ClockFit::add(double own_s, double host_s) {
  const double ahead_s = host_s - own_s;
  if (!std::isfinite(ahead_s)) return;
  if (points_.empty() || own_s >= next_s_) {
    if (points_.size() == most_points) halve();
    points_.push_back({own_s, ahead_s});
    next_s_ = (std::floor(own_s / stretch_s_) + 1.0) * stretch_s_;
  } else if (ahead_s < points_.back().ahead_s) {
    points_.back() = {own_s, ahead_s};
  }
}

void ClockFit::halve() {
  for (std::size_t i = 0; i < most_points / 2; ++i) {
    const Point& a = points_[2 * i];
    const Point& b = points_[2 * i + 1];
    points_[i] = a.ahead_s < b.ahead_s ? a : b;
  }
  points_.resize(most_points / 2);
  stretch_s_ *= 2.0;
}

std::optional<Uncertain> ClockFit::rate_error() const {
  const auto n = static_cast<double>(points_.size());
  if (points_.size() < least_points || points_.back().own_s - points_.front().own_s < least_span_s)
    return std::nullopt;
  double mean_x = 0.0, mean_y = 0.0;
  for (const Point& p : points_) {
    mean_x += p.own_s / n;
    mean_y += p.ahead_s / n;
  }
  double xx = 0.0, xy = 0.0;
  for (const Point& p : points_) {
    xx += (p.own_s - mean_x) * (p.own_s - mean_x);
    xy += (p.own_s - mean_x) * (p.ahead_s - mean_y);
  }
  const double slope = xy / xx;
  double squares = 0.0, neighbours = 0.0, before = 0.0;
  for (const Point& p : points_) {
    const double residual = p.ahead_s - mean_y - slope * (p.own_s - mean_x);
    squares += residual * residual;
    neighbours += before * residual;
    before = residual;
  }
  // Autocorrelation of a first-order process, if it exceeds the 95 % level of white scatter.
  // Fitting a line reduces it; the bias is corrected.
  const double found = squares > 0.0 ? neighbours / squares + 2.0 / n : 0.0;
  const double correlation = found > 1.645 / std::sqrt(n) ? std::min(found, 0.95) : 0.0;
  const double variance = squares / (n - 2.0) / xx * (1.0 + correlation) / (1.0 - correlation);
  return Uncertain{slope, std::sqrt(variance)};
}

}  // namespace proofmass::acquire
