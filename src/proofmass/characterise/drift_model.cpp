#include "proofmass/characterise/drift_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/characterise/drift/shapes.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

constexpr double two_sided_95 = 1.959963984540054;

double rise(double t_s, double time_constant_s) {
  return -std::expm1(-t_s / time_constant_s);
}

// ∂ rise / ∂ ln T.
double rise_by_log_time(double t_s, double time_constant_s) {
  const double ratio = t_s / time_constant_s;
  return -ratio * std::exp(-ratio);
}

Interval95 normal_interval(double value, double variance) {
  const double std = std::sqrt(std::max(variance, 0.0));
  return {value, std, value - two_sided_95 * std, value + two_sided_95 * std};
}

// E[(flicker(t) − its mean over the record's last blocks)²] grows with the logarithm of t: half the
// structure function 2 ∫ 2 S(f) (1 − cos 2πfΔ) df of S = B²/(2πf) above a cut at 1/h is
// (2 B²/π) (ln(2πΔ/h) + γ − Ci).
// Source: IEEE Std 952-1997, annex C, for S(f); the integral by parts.
double flicker_growth(double B, double ahead_s, double block_s) {
  if (ahead_s <= 0.0) return 0.0;
  return 2.0 * B * B / std::numbers::pi * std::log1p(2.0 * std::numbers::pi * ahead_s / block_s);
}

void add_rival(const DriftCurve& curve, double t_s, std::vector<double>& gradient) {
  double by_log_scale = 0.0;
  for (std::size_t k = 0; k < amplitudes_of(curve.shape); ++k) {
    const RivalColumn column{curve.shape, k, curve.time_constant_s};
    gradient.push_back(column.at(t_s));
    by_log_scale += (k == 0 ? curve.a1 : curve.second_a1) * column.by_log_scale(t_s);
  }
  if (scales_of(curve.shape) > 0) gradient.push_back(by_log_scale);
}

struct Horizon {
  double t_s = 0.0, block_s = 0.0;
};

DriftForecast forecast_of(const DriftPossibility& one, const Horizon& horizon) {
  const DriftNoise& noise = one.noise;
  const double ahead_s = horizon.t_s - one.end.t_s;
  // A random walk and flicker keep their expectation, a Markov process relaxes to zero.
  const double kept = noise.markov > 0.0 ? std::exp(-ahead_s / noise.markov_time_constant_s) : 0.0;
  const double growth = noise.random_walk * noise.random_walk * ahead_s +
                        flicker_growth(noise.flicker, ahead_s, horizon.block_s) +
                        (1.0 - kept * kept) * noise.markov_std() * noise.markov_std();
  const Eigen::VectorXd now = one.curve.gradient(one.end.t_s);
  const Eigen::VectorXd then = one.curve.gradient(horizon.t_s);
  const auto interval = [&](double value, const Eigen::VectorXd& of_curve,
                            const Eigen::Vector3d& of_slow_noise) {
    Eigen::VectorXd g(of_curve.size() + 3);
    g << of_curve, of_slow_noise;
    return normal_interval(value + of_slow_noise.dot(one.end.slow_noise),
                           g.dot(one.end.covariance * g) + growth);
  };
  const double level = one.curve.value(horizon.t_s);
  return {horizon.t_s, interval(level, then, {1.0, 1.0, kept}),
          interval(level - one.curve.value(one.end.t_s), then - now, {0.0, 0.0, kept - 1.0})};
}

}  // namespace

Interval95 covering(View<Interval95> intervals, View<DriftPossibility> possibilities) {
  PM_EXPECTS(intervals.size() == possibilities.size() && !intervals.empty());
  Interval95 all{0.0, 0.0, intervals.front().lower_95, intervals.front().upper_95};
  double squares = 0.0;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const Interval95& one = intervals[k];
    const double weight = possibilities[k].weight;
    all.value += weight * one.value;
    squares += weight * (one.std * one.std + one.value * one.value);
    const bool bounded_below = all.lower_95 && one.lower_95;
    all.lower_95 =
        bounded_below ? std::optional(std::min(*all.lower_95, *one.lower_95)) : std::nullopt;
    const bool bounded_above = all.upper_95 && one.upper_95;
    all.upper_95 =
        bounded_above ? std::optional(std::max(*all.upper_95, *one.upper_95)) : std::nullopt;
  }
  all.std = std::sqrt(std::max(0.0, squares - all.value * all.value));
  return all;
}

std::string_view name_of(DriftShape shape) {
  constexpr std::array<std::string_view, 11> names{"constant",
                                                   "line",
                                                   "steps",
                                                   "exponential",
                                                   "exponential_and_line",
                                                   "two_exponentials",
                                                   "square_root",
                                                   "logarithm",
                                                   "hyperbola",
                                                   "stretched_exponential",
                                                   "sine"};
  return names[static_cast<std::size_t>(shape)];
}

double DriftNoise::markov_std() const {
  return markov * std::sqrt(0.5 * markov_time_constant_s);
}

double DriftCurve::value(double t_s) const {
  double y = a2;
  if (is_exponential(shape)) y += a1 * rise(t_s, time_constant_s);
  if (shape == DriftShape::two_exponentials) y += second_a1 * rise(t_s, second_time_constant_s);
  if (is_rival(shape)) y += a1 * RivalColumn{shape, 0, time_constant_s}.at(t_s);
  if (shape == DriftShape::sine) y += second_a1 * RivalColumn{shape, 1, time_constant_s}.at(t_s);
  if (has_line(shape)) y += slope_per_s * t_s;
  for (const DriftStep& step : steps)
    if (t_s >= step.t_s) y += step.size.value;
  return y;
}

Eigen::VectorXd DriftCurve::gradient(double t_s) const {
  std::vector<double> g{1.0};
  const auto exponential = [&](double amplitude, double time_s) {
    g.push_back(rise(t_s, time_s));
    g.push_back(amplitude * rise_by_log_time(t_s, time_s));
  };
  if (is_exponential(shape)) exponential(a1, time_constant_s);
  if (shape == DriftShape::two_exponentials) exponential(second_a1, second_time_constant_s);
  if (is_rival(shape)) add_rival(*this, t_s, g);
  if (has_line(shape)) g.push_back(t_s);
  for (const DriftStep& step : steps) g.push_back(t_s >= step.t_s ? 1.0 : 0.0);
  return Eigen::Map<const Eigen::VectorXd>(g.data(), static_cast<Eigen::Index>(g.size()));
}

double DriftCurve::std(double t_s) const {
  const Eigen::VectorXd g = gradient(t_s);
  PM_EXPECTS(covariance.rows() == g.size());
  return std::sqrt(std::max(0.0, g.dot(covariance * g)));
}

Result<DriftForecast> forecast(const DriftFit& fit, double t_s) {
  if (!std::isfinite(t_s) || t_s < fit.end.t_s)
    return Error{Errc::invalid_argument,
                 fmt::format("the forecast for {:g} s is before the end of the recording at {:g} "
                             "s after power-on: give a later time",
                             t_s, fit.end.t_s)};
  if (fit.identified)
    return forecast_of(fit.hidden_walk.value_or(DriftPossibility{fit.curve, fit.noise, fit.end}),
                       {t_s, fit.block_s});
  if (fit.possibilities.empty()) return Error{Errc::not_observable, fit.reason};
  std::vector<Interval95> bias, change;
  for (const DriftPossibility& one : fit.possibilities) {
    const DriftForecast found = forecast_of(one, {t_s, fit.block_s});
    bias.push_back(found.bias);
    change.push_back(found.change);
  }
  return DriftForecast{t_s, covering(bias, fit.possibilities), covering(change, fit.possibilities)};
}

Interval95 position_error(const Interval95& bias, double t_s) {
  const double half_square = 0.5 * t_s * t_s;
  const auto scaled = [&](const std::optional<double>& end) {
    return end ? std::optional(*end * half_square) : std::nullopt;
  };
  return {bias.value * half_square, bias.std * half_square, scaled(bias.lower_95),
          scaled(bias.upper_95)};
}

}  // namespace proofmass::characterise
