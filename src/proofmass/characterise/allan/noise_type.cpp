#include "proofmass/characterise/allan/noise_type.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "proofmass/characterise/allan/edf.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

constexpr std::size_t fewest_for_lag1 = 30;
constexpr std::size_t fewest_for_ratio = 7;

std::vector<double> decimated(View<double> phase, std::size_t m) {
  std::vector<double> out;
  out.reserve(phase.size() / m + 1);
  for (std::size_t i = 0; i < phase.size(); i += m) out.push_back(phase[i]);
  return out;
}

double mean_of(View<double> z) {
  return std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size());
}

/// Subtracts the least-squares parabola, one orthogonal polynomial after the other.
void remove_parabola(std::vector<double>& z) {
  const auto n = static_cast<double>(z.size());
  const double middle = 0.5 * (n - 1.0);
  const double mean_square = (n * n - 1.0) / 12.0;  // of t over the points
  const auto take_away = [&](auto polynomial) {
    double projection = 0.0;
    double norm = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double p = polynomial(static_cast<double>(i) - middle);
      projection += p * z[i];
      norm += p * p;
    }
    for (std::size_t i = 0; i < z.size(); ++i)
      z[i] -= projection / norm * polynomial(static_cast<double>(i) - middle);
  };
  take_away([](double) { return 1.0; });
  take_away([](double t) { return t; });
  take_away([=](double t) { return t * t - mean_square; });
}

/// NaN if z is constant.
double lag1_autocorrelation(View<double> z) {
  const double mean = mean_of(z);
  double lagged = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    squares += (z[i] - mean) * (z[i] - mean);
    if (i > 0) lagged += (z[i] - mean) * (z[i - 1] - mean);
  }
  return lagged / squares;
}

void difference(std::vector<double>& z) {
  std::adjacent_difference(z.begin(), z.end(), z.begin());
  z.erase(z.begin());
}

/// Expected B1 of n averages. Source: see ratio_noise_type.
double expected_b1(double n, int mu) {
  if (mu == 0) return n * std::log(n) / (2.0 * (n - 1.0) * std::numbers::ln2);
  return n * (1.0 - std::pow(n, mu)) / (2.0 * (n - 1.0) * (1.0 - std::pow(2.0, mu)));
}

double overlapping_allan_variance(View<double> phase, std::size_t m) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 * m < phase.size(); ++i) {
    const double z = phase[i + 2 * m] - 2.0 * phase[i + m] + phase[i];
    sum += z * z;
  }
  return sum / static_cast<double>(phase.size() - 2 * m);
}

double modified_allan_variance(View<double> phase, std::size_t m) {
  const std::size_t terms = phase.size() - 3 * m + 1;
  const auto second_difference = [&](std::size_t i) {
    return phase[i + 2 * m] - 2.0 * phase[i + m] + phase[i];
  };
  double window = 0.0;
  for (std::size_t i = 0; i < m; ++i) window += second_difference(i);
  double sum = window * window;
  for (std::size_t i = 1; i < terms; ++i) {
    window += second_difference(i + m - 1) - second_difference(i - 1);
    sum += window * window;
  }
  return sum / static_cast<double>(terms) / static_cast<double>(m * m);
}

/// 2 or 1, by the ratio of the modified to the Allan variance.
int white_or_flicker_phase(View<double> phase, std::size_t m) {
  const auto n = static_cast<double>(m);
  const double flicker = 3.37 / (1.04 + 3.0 * std::log(std::numbers::pi * n));
  const double ratio = modified_allan_variance(phase, m) / overlapping_allan_variance(phase, m);
  return ratio > std::sqrt(flicker / n) ? 1 : 2;
}

}  // namespace

std::optional<NoiseType> lag1_noise_type(View<double> phase, std::size_t m, int lowest) {
  PM_EXPECTS(m >= 1 && (lowest == -2 || lowest == -4));
  std::vector<double> z = decimated(phase, m);
  if (z.size() < fewest_for_lag1) return std::nullopt;
  remove_parabola(z);
  const int d_max = lowest < -2 ? 3 : 2;
  for (int d = 0;; ++d) {
    const double r1 = lag1_autocorrelation(z);
    if (!std::isfinite(r1)) return std::nullopt;
    const double delta = r1 / (1.0 + r1);
    if (delta < 0.25 || d == d_max) {
      const double exponent = 2.0 - 2.0 * (delta + d);
      const int alpha = 2 - 2 * d - static_cast<int>(std::lround(2.0 * delta));
      return NoiseType{std::clamp(alpha, lowest, 2), exponent};
    }
    difference(z);
  }
}

std::optional<int> ratio_noise_type(View<double> phase, std::size_t m, int lowest) {
  PM_EXPECTS(m >= 1 && (lowest == -2 || lowest == -4));
  std::vector<double> averages = decimated(phase, m);
  if (averages.size() < fewest_for_ratio + 1) return std::nullopt;
  difference(averages);
  const auto n = static_cast<double>(averages.size());
  const double mean = mean_of(averages);
  double squares = 0.0;
  double differences = 0.0;
  for (std::size_t i = 0; i < averages.size(); ++i) {
    squares += (averages[i] - mean) * (averages[i] - mean);
    if (i > 0) differences += (averages[i] - averages[i - 1]) * (averages[i] - averages[i - 1]);
  }
  if (!(squares > 0.0)) return std::nullopt;
  const double b1 = 2.0 * squares / differences;
  for (int alpha = lowest; alpha <= 0; ++alpha) {
    const int mu = -1 - alpha;
    if (b1 > std::sqrt(expected_b1(n, mu) * expected_b1(n, mu - 1))) return alpha;
  }
  return white_or_flicker_phase(phase, m);
}

std::vector<int> identify_noise_types(View<double> phase,
                                      View<std::size_t> factors,
                                      Statistic statistic) {
  const int lowest = lowest_alpha(statistic);
  std::vector<int> alphas;
  alphas.reserve(factors.size());
  int last = 0;
  for (std::size_t m : factors) {
    if (statistic == Statistic::theo1) m = std::max<std::size_t>(1, (3 * m + 2) / 4);
    if (const auto by_lag1 = lag1_noise_type(phase, m, lowest))
      last = by_lag1->alpha;
    else if (const auto by_ratio = ratio_noise_type(phase, m, lowest))
      last = *by_ratio;
    alphas.push_back(last);
  }
  return alphas;
}

}  // namespace proofmass::characterise
