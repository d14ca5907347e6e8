#include "proofmass/signal/fourier.hpp"

#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace proofmass::signal {
namespace {

using Complexes = std::vector<std::complex<double>>;

std::size_t largest_prime_factor(std::size_t n) {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; ++p)
    for (; n % p == 0; n /= p) largest = p;
  return n > 1 ? n : largest;
}

/// exp(−iπ k / n), with k reduced to one turn first so that large k lose no digits.
std::complex<double> turn(std::uint64_t k, std::size_t n) {
  const double angle =
      -std::numbers::pi * static_cast<double>(k % (2 * n)) / static_cast<double>(n);
  return {std::cos(angle), std::sin(angle)};
}

/// The discrete Fourier transform as a convolution with a chirp c[n] = exp(−iπ n²/N):
///     V[k] = c[k] Σ v[n] c[n] c*[k − n].
Complexes bluestein(const std::vector<double>& v) {
  const std::size_t n = v.size(), length = std::bit_ceil(2 * n - 1);
  Complexes chirp(n), a(length), b(length), spectrum;
  for (std::size_t k = 0; k < n; ++k) {
    chirp[k] = turn(std::uint64_t{k} * k, n);
    a[k] = v[k] * chirp[k];
    b[k] = std::conj(chirp[k]);
    if (k > 0) b[length - k] = b[k];
  }
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, a);
  fft.fwd(a, b);
  for (std::size_t k = 0; k < length; ++k) spectrum[k] *= a[k];
  fft.inv(a, spectrum);
  for (std::size_t k = 0; k < n; ++k) a[k] *= chirp[k];
  return a;
}

Complexes fourier_transform(const std::vector<double>& v) {
  // The library takes N p steps for a prime factor p.
  if (largest_prime_factor(v.size()) > 31) return bluestein(v);
  Complexes spectrum;
  Eigen::FFT<double>().fwd(spectrum, v);
  return spectrum;
}

}  // namespace

std::vector<double> cosine_transform(View<double> series) {
  const std::size_t n = series.size();
  if (n < 2) return {series.begin(), series.end()};
  std::vector<double> folded(n);
  for (std::size_t k = 0; k < n; ++k) folded[k % 2 == 0 ? k / 2 : n - 1 - k / 2] = series[k];
  const Complexes spectrum = fourier_transform(folded);
  const double scale = std::sqrt(2.0 / static_cast<double>(n));
  for (std::size_t k = 0; k < n; ++k) folded[k] = scale * (turn(k, 2 * n) * spectrum[k]).real();
  folded[0] *= std::numbers::sqrt2 / 2.0;
  return folded;
}

std::vector<double> cosine_sums(View<double> weights) {
  const std::size_t n = weights.size();
  if (n == 0) return {};
  std::vector<double> even(2 * n, 0.0);
  even[0] = weights[0];
  for (std::size_t k = 1; k < n; ++k) even[k] = even[2 * n - k] = 0.5 * weights[k];
  const Complexes spectrum = fourier_transform(even);
  std::vector<double> sums(n + 1);
  for (std::size_t d = 0; d <= n; ++d) sums[d] = spectrum[d].real();
  return sums;
}

}  // namespace proofmass::signal
