#include "proofmass/characterise/allan/deviation_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/characterise/allan/averaging_times.hpp"
#include "proofmass/characterise/allan/deviation_bias.hpp"
#include "proofmass/characterise/allan/difference_variance.hpp"
#include "proofmass/characterise/allan/edf.hpp"
#include "proofmass/characterise/allan/noise_type.hpp"
#include "proofmass/characterise/allan/parabolic_variance.hpp"
#include "proofmass/characterise/allan/theo1.hpp"
#include "proofmass/characterise/allan/total_variance.hpp"
#include "proofmass/core/chi_square.hpp"

namespace proofmass::characterise {
namespace {

constexpr std::size_t longest_filled_gap = 8;

// The longest stretch without a long gap, with short gaps interpolated linearly.
std::vector<double> longest_stretch(View<double> series) {
  std::size_t best_first = 0, best_end = 0, first = series.size(), last = 0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (!std::isfinite(series[k])) continue;
    if (first == series.size() || k - last > longest_filled_gap + 1) first = k;
    last = k;
    if (last + 1 - first > best_end - best_first) {
      best_first = first;
      best_end = last + 1;
    }
  }
  std::vector<double> stretch(series.begin() + static_cast<std::ptrdiff_t>(best_first),
                              series.begin() + static_cast<std::ptrdiff_t>(best_end));
  last = 0;
  for (std::size_t k = 1; k < stretch.size(); ++k) {
    if (!std::isfinite(stretch[k])) continue;
    const double step = (stretch[k] - stretch[last]) / static_cast<double>(k - last);
    for (std::size_t j = last + 1; j < k; ++j)
      stretch[j] = stretch[last] + step * static_cast<double>(j - last);
    last = k;
  }
  return stretch;
}

// x, the integral of the stretch minus its mean, which would otherwise dominate.
std::vector<double> phase_of(View<double> stretch, double tau0_s) {
  double mean = 0.0;
  for (const double y : stretch) mean += y / static_cast<double>(stretch.size());
  std::vector<double> phase(stretch.size() + 1, 0.0);
  for (std::size_t k = 0; k < stretch.size(); ++k)
    phase[k + 1] = phase[k] + (stretch[k] - mean) * tau0_s;
  return phase;
}

PhaseVariance whole_record_variance(Statistic statistic,
                                    View<double> phase,
                                    double tau0_s,
                                    std::size_t m) {
  switch (statistic) {
    case Statistic::totdev:
      return total_variance(phase, tau0_s, m);
    case Statistic::htotdev:
      return hadamard_total_variance(phase, tau0_s, m);
    case Statistic::theo1:
      return theo1(phase, tau0_s, m);
    case Statistic::pdev:
      return parabolic_variance(phase, tau0_s, m);
    default:
      return modified_total_variance(phase, tau0_s, m);
  }
}

// From the variance to the deviation: times τ/√3 where the statistic is one of time.
double time_factor(Statistic statistic, double tau_s) {
  const bool of_time = statistic == Statistic::tdev || statistic == Statistic::ttotdev;
  return of_time ? tau_s / std::numbers::sqrt3 : 1.0;
}

double effective_tau(Statistic statistic, std::size_t m, double tau0_s) {
  return static_cast<double>(m) * tau0_s * (statistic == Statistic::theo1 ? 0.75 : 1.0);
}

std::size_t place(int alpha) {
  return static_cast<std::size_t>(2 - alpha);
}

// Shares of the model's terms in the Allan variance at τ.
AlphaShares shares_at(const NoiseModelFit& model, double tau_s) {
  AlphaShares shares{};
  shares[place(2)] = model.allan_variance(Term::quantisation, tau_s);
  // Below the time constant of its filter, white noise is correlated like a random walk.
  const double filter_s =
      model.bandwidth_hz ? 1.0 / (2.0 * std::numbers::pi * model.bandwidth_hz->value) : 0.0;
  shares[place(tau_s < filter_s ? -2 : 0)] += model.allan_variance(Term::white, tau_s);
  shares[place(-1)] = model.allan_variance(Term::flicker, tau_s);
  shares[place(-2)] += model.allan_variance(Term::random_walk, tau_s);
  if (model.markov) {
    // The maximum of its curve is at 1.89 T.
    const bool rising = tau_s < 1.89 * model.markov->time_constant_s.value;
    shares[place(rising ? -2 : 0)] += model.allan_variance(Term::markov, tau_s);
  }
  if (std::all_of(shares.begin(), shares.end(), [](double s) { return s == 0.0; }))
    shares[place(0)] = 1.0;
  return shares;
}

int dominant(const AlphaShares& shares) {
  return 2 - static_cast<int>(std::max_element(shares.begin(), shares.end()) - shares.begin());
}

EdfCase edf_case(const CurveVariances& from, Statistic statistic, std::size_t m) {
  const bool modified = statistic == Statistic::mdev || statistic == Statistic::tdev;
  return {.alpha = 0,
          .d = statistic == Statistic::hdev || statistic == Statistic::ohdev ? 3 : 2,
          .m = m,
          .phase_points = from.phase_points,
          .stride = DifferenceVariances::stride(statistic, m, from.least_overlap),
          .modified = modified && m > 1,
          .sampled = true};
}

// Share of the terms that a record without gaps would have.
double share_of_terms(const CurveVariances& from, const EdfCase& known, std::size_t terms) {
  const std::size_t order = static_cast<std::size_t>(known.d) + (known.modified ? 1 : 0);
  const std::size_t length = known.m * order + (known.modified ? 0 : 1);
  if (from.phase_points < length) return 1.0;
  const std::size_t all = 1 + (from.phase_points - length) / known.stride;
  return std::min(1.0, static_cast<double>(terms) / static_cast<double>(all));
}

// For the total variance at few samples per τ the published fit is up to a third too high. There it
// is the overlapping Allan variance with a few more terms.
double total_edf_of_few_samples(const CurveVariances& from,
                                std::size_t m,
                                const AlphaShares& shares) {
  const auto N = static_cast<double>(from.phase_points);
  const double plain =
      mixed_edf({.m = m, .phase_points = from.phase_points, .sampled = true}, shares);
  return plain * (N - 2.0) / (N - 2.0 * static_cast<double>(m));
}

double degrees_of_freedom(const CurveVariances& from,
                          const DeviationPoint& point,
                          const AlphaShares& shares,
                          const NoiseOptions& options) {
  const Statistic statistic = options.statistic;
  const bool by_model = options.noise_type == NoiseTypeSource::model;
  if (is_difference(statistic)) {
    const EdfCase known = edf_case(from, statistic, point.m);
    const double of_all = by_model ? mixed_edf(known, shares)
                                   : edf(statistic, point.alpha, point.m, from.phase_points);
    return of_all * share_of_terms(from, known, point.terms);
  }
  const double fitted = edf(statistic, point.alpha, point.m, from.phase_points);
  if (statistic != Statistic::totdev || !by_model || from.phase_points <= 2 * point.m)
    return fitted;
  const double of_few = total_edf_of_few_samples(from, point.m, shares);
  return point.m == 1 ? of_few : std::min(fitted, of_few);
}

}  // namespace

CurveVariances whole_record_variances(View<double> series, const NoiseOptions& options) {
  const double tau0_s = 1.0 / options.rate_hz;
  const std::vector<double> stretch = longest_stretch(series);
  const std::vector<double> phase = phase_of(stretch, tau0_s);
  CurveVariances curve;
  curve.factors = averaging_factors(options.taus, options.statistic, stretch.size(), tau0_s);
  curve.phase_points = phase.size();
  curve.left_out = series.size() - stretch.size();
  for (const std::size_t m : curve.factors)
    curve.variances.push_back(whole_record_variance(options.statistic, phase, tau0_s, m));
  return curve;
}

DeviationCurve deviation_curve(const CurveVariances& variances,
                               const NoiseModelFit& model,
                               View<double> series,
                               const NoiseOptions& options) {
  const Statistic statistic = options.statistic;
  const double tau0_s = 1.0 / options.rate_hz;
  DeviationCurve curve{statistic, options.confidence, {}, bias_correction(statistic)};
  std::vector<int> lag1;
  if (options.noise_type == NoiseTypeSource::lag1)
    lag1 = identify_noise_types(phase_of(longest_stretch(series), tau0_s), variances.factors,
                                statistic);
  for (std::size_t k = 0; k < variances.factors.size(); ++k) {
    const PhaseVariance& found = variances.variances[k];
    if (found.terms == 0) continue;
    DeviationPoint point;
    point.m = variances.factors[k];
    point.tau_s = effective_tau(statistic, point.m, tau0_s);
    point.terms = found.terms;
    const AlphaShares shares = shares_at(model, point.tau_s);
    point.alpha = dominant(shares);
    if (!lag1.empty()) {
      point.alpha_lag1 = lag1[k];
      point.alpha = lag1[k];
    }
    if (options.noise_type == NoiseTypeSource::fixed)
      point.alpha = std::max(options.alpha, lowest_alpha(statistic));
    point.edf = degrees_of_freedom(variances, point, shares, options);
    const double bias = variance_bias(statistic, point.alpha, point.m, variances.phase_points);
    const double to_deviation = time_factor(statistic, point.tau_s);
    point.uncorrected = std::sqrt(found.variance) * to_deviation;
    point.value = point.uncorrected / std::sqrt(bias);
    const double tail = 0.5 * (1.0 - options.confidence);
    point.lower = point.value * std::sqrt(point.edf / chi_square_quantile(1.0 - tail, point.edf));
    point.upper = point.value * std::sqrt(point.edf / chi_square_quantile(tail, point.edf));
    curve.points.push_back(point);
  }
  return curve;
}

}  // namespace proofmass::characterise
