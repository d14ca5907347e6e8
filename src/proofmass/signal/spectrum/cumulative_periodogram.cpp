#include "proofmass/signal/spectrum/cumulative_periodogram.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "proofmass/signal/spectrum/lagged_products.hpp"

namespace proofmass::signal {
namespace {

constexpr std::size_t most_values_at_once = 65'536;
constexpr std::size_t stretch = 8192;

/// True if all prime factors are 31 or less.
bool transforms_quickly(std::size_t n) {
  for (std::size_t p = 2; p <= 31; ++p)
    while (n % p == 0) n /= p;
  return n == 1;
}

/// Ordinates of the periodogram between zero and half the rate, up to a factor, and the number of
/// periodograms summed.
struct Ordinates {
  std::vector<double> values;
  double averaged = 1.0;
};

Ordinates at_once(View<double> series, double mean) {
  std::size_t n = series.size();
  while (!transforms_quickly(n)) --n;
  std::vector<double> centred(n);
  for (std::size_t k = 0; k < n; ++k) centred[k] = series[k] - mean;
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double>().fwd(spectrum, centred);
  Ordinates ordinates;
  for (std::size_t k = 1; 2 * k < n; ++k) ordinates.values.push_back(std::norm(spectrum[k]));
  return ordinates;
}

Ordinates by_stretches(View<double> series, double mean) {
  const std::size_t count = series.size() / stretch;
  const Stretches stretches{series.first(count * stretch), mean, false, stretch, stretch};
  const LaneFourier fourier(stretch);
  std::vector<LaneComplex> x(stretch);
  std::vector<LaneReal> sums(stretch);
  for (std::size_t first = 0; first < stretches.series.size(); first += 2 * lanes * stretch) {
    load_stretches(stretches, first, x);
    fourier.add_power(x, sums);
  }
  const std::vector<double> power = fourier.real_power(sums);
  return {{power.begin() + 1, power.end() - 1}, static_cast<double>(count)};
}

}  // namespace

double kolmogorov_p(double lambda) {
  double sum = 0.0;
  if (lambda < 1.0) {
    // The same by Poisson's summation, because the other series does not converge as λ goes to
    // zero.
    if (lambda < 0.1) return 1.0;
    for (int j = 1; j <= 9; j += 2)
      sum += std::exp(-std::pow(j * std::numbers::pi / lambda, 2) / 8.0);
    return 1.0 - std::sqrt(2.0 * std::numbers::pi) / lambda * sum;
  }
  for (int j = 1; j <= 6; ++j)
    sum += (j % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * j * j * lambda * lambda);
  return sum;
}

PeriodogramTest test_cumulative_periodogram(View<double> series, double mean) {
  const auto [ordinates, averaged] =
      series.size() > most_values_at_once ? by_stretches(series, mean) : at_once(series, mean);
  const double total = std::reduce(ordinates.begin(), ordinates.end());
  const double steps = averaged * static_cast<double>(ordinates.size()) - 1.0;
  if (!(total > 0.0)) return {1.0, 0.0};  // all power is at half the rate
  PeriodogramTest test;
  double sum = 0.0, position = 0.0;
  for (std::size_t j = 0; j + 1 < ordinates.size(); ++j) {
    sum += ordinates[j];
    position += averaged;
    const double below = (position - 1.0) / steps, above = position / steps;
    test.excess = std::max({test.excess, sum / total - below, above - sum / total});
  }
  const double root = std::sqrt(steps);
  test.p = kolmogorov_p((root + 0.12 + 0.11 / root) * test.excess);
  return test;
}

}  // namespace proofmass::signal
