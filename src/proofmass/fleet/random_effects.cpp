#include "proofmass/fleet/random_effects.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "proofmass/core/statistics.hpp"

namespace proofmass::fleet {
namespace {

constexpr double tail = 0.025;  // beyond either end of a 95 % interval

// The value in (0, ∞) at which a falling function is zero; 0 where it begins below.
double root_of_falling(const std::function<double(double)>& f, double scale) {
  if (f(0.0) <= 0.0) return 0.0;
  double low = 0.0, high = scale;
  for (int k = 0; k < 200 && f(high) > 0.0; ++k) high *= 2.0;
  for (int k = 0; k < 200 && high - low > 1e-12 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The F that is exceeded with probability p.
double fisher_f_exceeded(double p, double above, double below) {
  return root_of_falling([&](double f) { return fisher_f_p(f, above, below) - p; }, 1.0);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Sums of squares of an analysis of variance over the sensors' means.
struct Anova {
  double mean = 0.0, means_variance = 0.0, within_squares = 0.0, harmonic_count = 0.0;
  std::size_t sensors = 0, values = 0;
};

Anova anova(const std::vector<SensorValues>& sensors) {
  Anova sums;
  std::vector<double> means;
  double inverse_counts = 0.0;
  for (const SensorValues& sensor : sensors) {
    means.push_back(mean_of(sensor.values));
    for (const double value : sensor.values) sums.within_squares += square(value - means.back());
    inverse_counts += 1.0 / static_cast<double>(sensor.values.size());
    sums.values += sensor.values.size();
  }
  sums.sensors = means.size();
  const auto k = static_cast<double>(means.size());
  sums.mean = mean_of(means);
  for (const double mean : means) sums.means_variance += square(mean - sums.mean) / (k - 1.0);
  sums.harmonic_count = k / inverse_counts;
  return sums;
}

// The interval of τ² = (S1² − S2²)/n by the modified large-sample method, S1² with n1 and S2² with
// n2 degrees of freedom. The constants G and H make either end exact where one of the two vanishes.
Bounds between_variance_95(double s1, double n1, double s2, double n2, double n) {
  const double estimate = s1 - s2;
  const double g1 = 1.0 - n1 / chi_square_quantile(1.0 - tail, n1);
  const double g2 = 1.0 - n2 / chi_square_quantile(1.0 - tail, n2);
  const double h1 = n1 / chi_square_quantile(tail, n1) - 1.0;
  const double h2 = n2 / chi_square_quantile(tail, n2) - 1.0;
  const double f_high = fisher_f_exceeded(tail, n1, n2);
  const double f_low = fisher_f_exceeded(1.0 - tail, n1, n2);
  const double g12 = (square(f_high - 1.0) - square(g1 * f_high) - square(h2)) / f_high;
  const double h12 = (square(1.0 - f_low) - square(h1 * f_low) - square(g2)) / f_low;
  const double below = square(g1 * s1) + square(h2 * s2) + g12 * s1 * s2;
  const double above = square(h1 * s1) + square(g2 * s2) + h12 * s1 * s2;
  return {std::max(0.0, (estimate - std::sqrt(std::max(0.0, below))) / n),
          std::max(0.0, (estimate + std::sqrt(std::max(0.0, above))) / n)};
}

Bounds around(double value, double reach) {
  return {value - reach, value + reach};
}

RandomEffects of_repeats(const Anova& sums) {
  const auto k = static_cast<double>(sums.sensors);
  const double dof = static_cast<double>(sums.values) - k;
  const double within = sums.within_squares / dof, n = sums.harmonic_count;
  RandomEffects fit;
  fit.sensors = sums.sensors;
  fit.values = sums.values;
  fit.mean = {sums.mean, std::sqrt(sums.means_variance / k)};
  fit.mean_95 = around(sums.mean, student_t_quantile(1.0 - tail, k - 1.0) * fit.mean.std);
  fit.between_std = std::sqrt(std::max(0.0, sums.means_variance - within / n));
  const Bounds variance = between_variance_95(n * sums.means_variance, k - 1.0, within, dof, n);
  fit.between_95 = {std::sqrt(variance.lower), std::sqrt(variance.upper)};
  fit.within_std = std::sqrt(within);
  fit.within_95 = {std::sqrt(sums.within_squares / chi_square_quantile(1.0 - tail, dof)),
                   std::sqrt(sums.within_squares / chi_square_quantile(tail, dof))};
  return fit;
}

/// One value a sensor, with its variance.
struct Single {
  double value, variance;
};

struct Weighted {
  double mean = 0.0, weights = 0.0, q = 0.0;
};

Weighted weighted(const std::vector<Single>& all, double between_variance) {
  Weighted sums;
  for (const Single& one : all) {
    const double weight = 1.0 / (one.variance + between_variance);
    sums.mean += weight * one.value;
    sums.weights += weight;
  }
  sums.mean /= sums.weights;
  for (const Single& one : all)
    sums.q += square(one.value - sums.mean) / (one.variance + between_variance);
  return sums;
}

RandomEffects of_singles(const std::vector<Single>& all, double scale) {
  const double dof = static_cast<double>(all.size()) - 1.0;
  const auto variance_at = [&](double q) {
    return root_of_falling([&](double variance) { return weighted(all, variance).q - q; }, scale);
  };
  RandomEffects fit;
  fit.sensors = fit.values = all.size();
  const double between = variance_at(dof);
  fit.between_std = std::sqrt(between);
  fit.between_95 = {std::sqrt(variance_at(chi_square_quantile(1.0 - tail, dof))),
                    std::sqrt(variance_at(chi_square_quantile(tail, dof)))};
  const Weighted sums = weighted(all, between);
  fit.mean = {sums.mean, std::sqrt(sums.q / (dof * sums.weights))};
  fit.mean_95 = around(sums.mean, student_t_quantile(1.0 - tail, dof) * fit.mean.std);
  return fit;
}

}  // namespace

std::optional<RandomEffects> fit_random_effects(const std::vector<SensorValues>& all) {
  std::vector<SensorValues> sensors;
  std::ranges::copy_if(all, std::back_inserter(sensors),
                       [](const SensorValues& one) { return !one.values.empty(); });
  if (sensors.size() < 3) return std::nullopt;
  const Anova sums = anova(sensors);
  if (sums.values > sums.sensors && sums.within_squares > 0.0) return of_repeats(sums);
  std::vector<Single> singles;
  for (const SensorValues& one : sensors)
    singles.push_back({mean_of(one.values), one.stds.empty() ? 0.0 : square(one.stds.front())});
  // A variance of exactly nothing would divide by it.
  const double least = 1e-18 * std::max(sums.means_variance, 1e-300);
  for (Single& one : singles) one.variance = std::max(one.variance, least);
  return of_singles(singles, std::max(sums.means_variance, 1e-300));
}

}  // namespace proofmass::fleet
