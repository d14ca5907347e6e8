#include "proofmass/characterise/drift/profile.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "proofmass/characterise/noise/golden_section.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double bound_95(double dof) {
  constexpr double two_sided = 0.975;
  const double t = student_t_quantile(two_sided, dof);
  return (dof + 1.0) * std::log1p(t * t / dof);
}

// For the variance C_ii of a parameter: u = X̃ C e_i gives ∂C_ii/∂θ_j = Σ u² P_j/S², and the
// strengths have the information ½ Σ P_i P_j/S².
double satterthwaite(const DriftFitAtShape& trial, const MatrixXd& X, const MatrixXd& C, Index i) {
  constexpr double least = 2.0, most = 1e6;
  const VectorXd inverse_square = trial.fit.density.cwiseAbs2().cwiseInverse();
  const MatrixXd& P = trial.noise.P;
  const VectorXd u = X * C.col(i);
  const VectorXd gradient = P.transpose() * inverse_square.cwiseProduct(u.cwiseAbs2());
  const MatrixXd information = 0.5 * P.transpose() * (inverse_square.asDiagonal() * P);
  const double variance = gradient.dot(positive_inverse(information) * gradient);
  const double dof = 2.0 * C(i, i) * C(i, i) / variance;
  return dof > least ? std::min(dof, most) : least;  // nothing known of it, too
}

// From `best` in steps to where the loss reaches its bound; nullopt beyond `limit`.
struct Way {
  double best, step, limit, bound;
};

std::optional<double> crossing(const Way& way, const std::function<double(double)>& loss) {
  const auto [best, first_step, limit, bound] = way;
  // The root of the loss is nearly linear.
  const double root_bound = std::sqrt(bound);
  const auto root = [&](double place) {
    return std::sqrt(std::max(0.0, loss(place))) - root_bound;
  };
  const auto before_limit = [&](double place) {
    return first_step > 0.0 ? std::min(place, limit) : std::max(place, limit);
  };
  double step = first_step;
  double inside = best, at_inside = -root_bound;
  double outside = before_limit(best + step), at_outside = root(outside);
  while (at_outside <= 0.0) {
    if (outside == limit) return std::nullopt;
    inside = outside;
    at_inside = at_outside;
    step *= 1.5;
    outside = before_limit(outside + step);
    at_outside = root(outside);
  }
  constexpr int most_rounds = 12;
  constexpr double near = 0.005;  // standard deviations
  double place = outside;
  for (int round = 0; round < most_rounds; ++round) {
    place = inside - at_inside * (outside - inside) / (at_outside - at_inside);
    const double found = root(place);
    if (std::abs(found) < near) break;
    (found > 0.0 ? outside : inside) = place;
    (found > 0.0 ? at_outside : at_inside) = found;
  }
  return place;
}

}  // namespace

DriftProfile::DriftProfile(const DriftEvidence& evidence, const DriftFitAtShape& trial)
    : evidence_(evidence), trial_(trial), adjusting_(tangent_columns(evidence, trial.at)) {
  top_ = trial.fit.log_likelihood;
  const MatrixXd information =
      adjusting_.transpose() * (trial.fit.density.cwiseInverse().asDiagonal() * adjusting_);
  const MatrixXd covariance = positive_inverse(information);
  const auto times = static_cast<Index>(trial.at.log_times.size());
  const Index first = covariance.rows() - evidence.dummies().cols() - times;
  for (Index k = 0; k < times; ++k) {
    const double amplitude = std::abs(trial.fit.coefficients(k));
    reach_.push_back(std::sqrt(covariance(first + k, first + k)) / amplitude);
  }
  amplitude_dof_ = satterthwaite(trial, adjusting_, covariance, 0);
  time_dof_ = satterthwaite(trial, adjusting_, covariance, first);
  slope_ = covariance(first, 0) / (covariance(0, 0) * trial.fit.coefficients(0));
}

// Loss with all linear parameters, and the noise, refitted.
double DriftProfile::loss(const Held& held, const ShapeAt& at) const {
  VectorXd z = evidence_.contrasts();
  OrdinateMeans means{linear_columns(evidence_, at), adjusting_, evidence_.missing()};
  if (held.amplitude) {
    z -= *held.amplitude * means.fitted.col(0);
    means.fitted = means.fitted.rightCols(means.fitted.cols() - 1).eval();
  }
  const OrdinateFit fit = fit_ordinates(z, trial_.noise.P, means, trial_.fit.strength);
  return 2.0 * (top_ - fit.log_likelihood);
}

// Loss at the best of the free time constants.
double DriftProfile::least_loss(const Held& held, const ShapeAt& at, std::size_t first_free) const {
  if (first_free >= at.log_times.size()) return loss(held, at);
  constexpr double standard_deviations = 3.0, tolerance = 0.05;
  const TimeRange range = time_range(evidence_);
  const double best = at.log_times[first_free], reach = standard_deviations * reach_[first_free];
  const Bracket bracket{std::max(best - reach, std::log(range.lower_s)),
                        std::min(best + reach, std::log(range.upper_s)),
                        tolerance * reach_[first_free]};
  return least_between(bracket,
                       [&](double log_time) {
                         ShapeAt there = at;
                         there.log_times[first_free] = log_time;
                         return least_loss(held, there, first_free + 1);
                       })
      .value;
}

double DriftProfile::of_log_time(double log_time) const {
  ShapeAt at = trial_.at;
  at.log_times.front() = log_time;
  return least_loss({.log_time = log_time, .amplitude = {}}, at, 1);
}

double DriftProfile::of_amplitude(double amplitude) const {
  ShapeAt at = trial_.at;
  at.log_times.front() += slope_ * (amplitude - trial_.fit.coefficients(0));
  return least_loss({.log_time = {}, .amplitude = amplitude}, at, 0);
}

Interval95 DriftProfile::time_constant(double std_of_log) const {
  const TimeRange range = time_range(evidence_);
  const double best = trial_.at.log_times.front(), step = std::min(1.8 * std_of_log, 1.0);
  const double bound = bound_95(time_dof_);
  const auto f = [&](double log_time) { return of_log_time(log_time); };
  const auto low = crossing({best, -step, std::log(range.lower_s), bound}, f);
  const auto high = crossing({best, step, std::log(range.upper_s), bound}, f);
  const auto time = [](std::optional<double> log_time) {
    return log_time ? std::optional(std::exp(*log_time)) : std::nullopt;
  };
  return {std::exp(best), std::exp(best) * std_of_log, time(low), time(high)};
}

Interval95 DriftProfile::amplitude(double std) const {
  constexpr double furthest = 60.0;  // standard deviations: a guard
  const double best = trial_.fit.coefficients(0), step = 1.8 * std;
  const double bound = bound_95(amplitude_dof_);
  const auto f = [&](double amplitude) { return of_amplitude(amplitude); };
  return {best, std, crossing({best, -step, best - furthest * std, bound}, f),
          crossing({best, step, best + furthest * std, bound}, f)};
}

std::vector<ProfilePoint> DriftProfile::points(const Interval95& interval) const {
  constexpr int count = 41;
  const TimeRange range = time_range(evidence_);
  const double best = std::log(interval.value), std_of_log = interval.std / interval.value;
  const auto reach = [&](std::optional<double> end) {
    constexpr double beyond = 1.7, widest = 3.0;
    return end ? beyond * std::abs(std::log(*end) - best) : std::max(widest, beyond * std_of_log);
  };
  const double low = std::max(best - reach(interval.lower_95), std::log(range.lower_s));
  const double high = std::min(best + reach(interval.upper_95), std::log(range.upper_s));
  std::vector<ProfilePoint> points;
  points.reserve(count);
  for (int k = 0; k < count; ++k) {
    const double log_time = low + (high - low) * k / (count - 1);
    points.push_back({std::exp(log_time), std::max(0.0, of_log_time(log_time))});
  }
  return points;
}

}  // namespace proofmass::characterise
