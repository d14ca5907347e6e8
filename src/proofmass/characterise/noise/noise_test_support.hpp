#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

// Noise with known coefficients, by methods independent of the code under test.
namespace proofmass::characterise::test {

using Series = std::vector<double>;

inline Series normals(std::size_t n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  Series z(n);
  for (double& value : z) value = normal(engine);
  return z;
}

inline Series scaled(Series z, double factor) {
  for (double& value : z) value *= factor;
  return z;
}

inline Series sum_of(const std::vector<Series>& parts) {
  Series sum(parts.front().size(), 0.0);
  for (const Series& part : parts)
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
  return sum;
}

/// N √rate w.
inline Series white(double N, double rate_hz, std::size_t n, unsigned seed) {
  return scaled(normals(n, seed), N * std::sqrt(rate_hz));
}

/// Q (w[k+1] − w[k]) / τ0: rate of a phase measured with independent errors.
inline Series quantisation(double Q, double rate_hz, std::size_t n, unsigned seed) {
  Series w = normals(n + 1, seed);
  for (std::size_t k = 0; k < n; ++k) w[k] = w[k + 1] - w[k];
  w.pop_back();
  return scaled(std::move(w), Q * rate_hz);
}

/// K √τ0 Σ w.
inline Series random_walk(double K, double rate_hz, std::size_t n, unsigned seed) {
  Series w = normals(n, seed);
  for (std::size_t k = 1; k < n; ++k) w[k] += w[k - 1];
  return scaled(std::move(w), K / std::sqrt(rate_hz));
}

/// A stationary process with autocorrelation exp(−|t|/T), sampled, with density 1 at frequency
/// zero.
inline Series relaxation(double time_constant_s, double rate_hz, std::size_t n, unsigned seed) {
  const double phi = std::exp(-1.0 / (time_constant_s * rate_hz));
  Series w = normals(n, seed);
  w[0] /= std::sqrt(1.0 - phi * phi);
  for (std::size_t k = 1; k < n; ++k) w[k] += phi * w[k - 1];
  return scaled(std::move(w), std::sqrt(rate_hz) * (1.0 - phi));
}

inline Series markov(
    double q, double time_constant_s, double rate_hz, std::size_t n, unsigned seed) {
  return scaled(relaxation(time_constant_s, rate_hz, n, seed), q * time_constant_s);
}

/// In-place transform of a power-of-two length; sign −1 forward, +1 inverse (without 1/n).
inline void fourier(std::vector<std::complex<double>>& z, double sign) {
  const std::size_t n = z.size();
  if (n == 1) return;
  std::vector<std::complex<double>> even(n / 2), odd(n / 2);
  for (std::size_t k = 0; k < n / 2; ++k) {
    even[k] = z[2 * k];
    odd[k] = z[2 * k + 1];
  }
  fourier(even, sign);
  fourier(odd, sign);
  for (std::size_t k = 0; k < n / 2; ++k) {
    const double angle =
        sign * 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    const std::complex<double> turned = std::polar(1.0, angle) * odd[k];
    z[k] = even[k] + turned;
    z[k + n / 2] = even[k] - turned;
  }
}

/// B (1 − z⁻¹)^(−½) w, after a run-in of equal length.
/// Source: N. J. Kasdin, Proc. IEEE 83 (1995) 802, equation 104.
inline Series flicker(double B, std::size_t n, unsigned seed) {
  std::size_t length = 1;
  while (length < 4 * n) length *= 2;
  std::vector<std::complex<double>> w(length), h(length);
  const Series drive = normals(2 * n, seed);
  double response = 1.0;
  for (std::size_t k = 0; k < 2 * n; ++k) {
    w[k] = drive[k];
    h[k] = response;
    response *= (static_cast<double>(k) + 0.5) / (static_cast<double>(k) + 1.0);
  }
  fourier(w, -1.0);
  fourier(h, -1.0);
  for (std::size_t k = 0; k < length; ++k) w[k] *= h[k];
  fourier(w, 1.0);
  Series y(n);
  for (std::size_t k = 0; k < n; ++k) y[k] = B * w[n + k].real() / static_cast<double>(length);
  return y;
}

inline Series ramp(double slope_per_s, double rate_hz, std::size_t n) {
  Series y(n);
  for (std::size_t k = 0; k < n; ++k) y[k] = slope_per_s * static_cast<double>(k) / rate_hz;
  return y;
}

inline Series sine(double amplitude, double frequency_hz, double rate_hz, std::size_t n) {
  Series y(n);
  for (std::size_t k = 0; k < n; ++k)
    y[k] = amplitude *
           std::sin(2.0 * std::numbers::pi * frequency_hz * static_cast<double>(k) / rate_hz);
  return y;
}

}  // namespace proofmass::characterise::test
