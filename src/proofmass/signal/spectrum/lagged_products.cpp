#include "proofmass/signal/spectrum/lagged_products.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

namespace proofmass::signal {
namespace {

constexpr std::size_t side_by_side = 2 * lanes;
/// Sixteen parallel transforms of eight times as many elements take 8 MiB.
constexpr std::size_t most_lags_by_stretches = 8192;

double loaded(const Stretches& s, double value) {
  if (!std::isfinite(value)) return 0.0;
  return s.presence ? 1.0 : value - s.mean;
}

/// Σ_j power[j] exp(2πi jk/T) / T for k = 0 … lags; power is even in j and given up to T/2.
std::vector<double> products_of_power(const std::vector<double>& power, std::size_t lags) {
  const std::size_t half = power.size() - 1;
  std::vector<std::complex<double>> spectrum(2 * half);
  for (std::size_t j = 0; j <= half; ++j)
    spectrum[j] = spectrum[(2 * half - j) % (2 * half)] = power[j];
  std::vector<std::complex<double>> products;
  Eigen::FFT<double>().inv(products, spectrum);
  std::vector<double> sums(lags + 1);
  for (std::size_t k = 0; k <= lags; ++k) sums[k] = products[k].real();
  return sums;
}

/// Products within each segment, summed. There is no wrap-around if a segment and `lags` zeros fit
/// into the transform.
std::vector<double> products_within(const Stretches& stretches,
                                    std::size_t first,
                                    std::size_t lags) {
  const std::size_t length = std::bit_ceil(std::max<std::size_t>(stretches.length + lags, 4));
  const LaneFourier fourier(length);
  std::vector<LaneComplex> x(length);
  std::vector<LaneReal> power(length);
  for (; first < stretches.series.size(); first += side_by_side * stretches.step) {
    load_stretches(stretches, first, x);
    fourier.add_power(x, power);
  }
  return products_of_power(fourier.real_power(power), lags);
}

/// Segments begin every `step` and are `lags` longer, so they contain every pair up to `lags`
/// apart. Pairs contained in two segments lie in their overlap, and are subtracted again.
std::vector<double> sums_by_stretches(Stretches stretches, std::size_t lags) {
  const std::size_t reach = std::max<std::size_t>(lags, 8);
  stretches.step = 6 * std::bit_ceil(reach);
  stretches.length = stretches.step + lags;
  std::vector<double> sums = products_within(stretches, 0, lags);
  if (stretches.step >= stretches.series.size()) return sums;
  stretches.length = lags;
  const std::vector<double> twice = products_within(stretches, stretches.step, lags);
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] -= twice[k];
  return sums;
}

/// By one transform of the whole series.
std::vector<double> sums_at_once(const Stretches& stretches, std::size_t lags) {
  std::vector<double> padded(std::bit_ceil(stretches.series.size() + lags), 0.0);
  std::ranges::transform(stretches.series, padded.begin(),
                         [&](double value) { return loaded(stretches, value); });
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double>().fwd(spectrum, padded);
  std::vector<double> power(padded.size() / 2 + 1);
  for (std::size_t j = 0; j < power.size(); ++j) power[j] = std::norm(spectrum[j]);
  return products_of_power(power, lags);
}

std::vector<double> sums(const Stretches& stretches, std::size_t lags) {
  return lags > most_lags_by_stretches ? sums_at_once(stretches, lags)
                                       : sums_by_stretches(stretches, lags);
}

}  // namespace

void load_stretches(const Stretches& s, std::size_t first, std::vector<LaneComplex>& x) {
  double* const out = reinterpret_cast<double*>(x.data());
  std::fill_n(out, x.size() * side_by_side, 0.0);
  const std::size_t size = s.series.size();
  // A few values of each segment in turn: sixteen whole ones would evict one another from the
  // cache.
  for (std::size_t block = 0; block < s.length; block += lanes)
    for (std::size_t stretch = 0; stretch < side_by_side; ++stretch) {
      const std::size_t begin = first + stretch * s.step + block;
      if (begin >= size) break;
      const std::size_t count = std::min({lanes, s.length - block, size - begin});
      for (std::size_t i = 0; i < count; ++i)
        out[(block + i) * side_by_side + stretch] = loaded(s, s.series[begin + i]);
    }
}

LaggedProducts lagged_products(View<double> series, double mean, std::size_t lags) {
  LaggedProducts products;
  products.sums = sums({series, mean, false, 0, 0}, lags);
  if (std::ranges::all_of(series, [](double x) { return std::isfinite(x); })) {
    for (std::size_t k = 0; k <= lags; ++k)
      products.pairs.push_back(k < series.size() ? static_cast<double>(series.size() - k) : 0.0);
  } else {
    products.pairs = sums({series, 0.0, true, 0, 0}, lags);
    for (double& pairs : products.pairs) pairs = std::round(pairs);
  }
  return products;
}

}  // namespace proofmass::signal
