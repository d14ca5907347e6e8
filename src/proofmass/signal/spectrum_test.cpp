#include "proofmass/signal/spectrum.hpp"

#include <cmath>
#include <complex>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace proofmass::signal::spectrum_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Independent uniform values of variance 1.
std::vector<double> white_noise(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<double> series(n);
  for (double& x : series)
    x = std::numbers::sqrt3 * (static_cast<double>(engine() >> 11) * 0x1p-52 - 1.0);
  return series;
}

std::vector<double> sine(std::size_t n, double cycles_per_sample, double amplitude) {
  std::vector<double> series(n);
  for (std::size_t i = 0; i < n; ++i)
    series[i] = amplitude * std::sin(2.0 * std::numbers::pi * cycles_per_sample * double(i) + 0.3);
  return series;
}

Spectrum spectrum_of(const std::vector<double>& series, double rate_hz, std::size_t segment) {
  return welch(series, {.rate_hz = rate_hz, .segment = segment}).value();
}

double integral(const Spectrum& spectrum) {
  return std::accumulate(spectrum.one_sided_psd.begin(), spectrum.one_sided_psd.end(), 0.0) *
         spectrum.rate_hz / static_cast<double>(spectrum.segment);
}

/// Welch's estimate at one bin, by the definition.
double by_definition(const std::vector<double>& x, double rate_hz, std::size_t L, std::size_t k) {
  double total = 0.0, segments = 0.0;
  for (std::size_t at = 0; at + L <= x.size(); at += L / 2, ++segments) {
    double sum = 0.0, valid = 0.0, window_power = 0.0;
    for (std::size_t n = 0; n < L; ++n)
      if (std::isfinite(x[at + n])) sum += x[at + n], ++valid;
    std::complex<double> transform;
    for (std::size_t n = 0; n < L; ++n) {
      if (!std::isfinite(x[at + n])) continue;
      const double turns = static_cast<double>(n) / static_cast<double>(L);
      const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * turns);
      window_power += w * w;
      transform += w * (x[at + n] - sum / valid) *
                   std::polar(1.0, -2.0 * std::numbers::pi * turns * static_cast<double>(k));
    }
    total += std::norm(transform) / window_power;
  }
  return total * (k == 0 || k == L / 2 ? 1.0 : 2.0) / (rate_hz * segments);
}

TEST(Welch, IsItsDefinitionInEveryBin) {
  for (const std::size_t L : {16u, 32u, 64u, 128u, 256u}) {
    std::vector<double> x = white_noise(23 * L + 5, L);
    for (std::size_t n = 0; n < x.size(); ++n) x[n] += 9.8 + 1e-3 * static_cast<double>(n);
    for (const std::size_t gap : {7u, 8u, 250u}) x[gap] = nan;
    const Spectrum spectrum = spectrum_of(x, 50.0, L);
    ASSERT_EQ(spectrum.one_sided_psd.size(), L / 2 + 1);
    EXPECT_EQ(spectrum.averaged, 45u);
    for (std::size_t k = 0; k <= L / 2; ++k) {
      EXPECT_NEAR(spectrum.one_sided_psd[k] / by_definition(x, 50.0, L, k), 1.0, 1e-9) << L;
      EXPECT_DOUBLE_EQ(spectrum.frequency_hz[k], static_cast<double>(k) * 50.0 / double(L));
    }
  }
}

TEST(Welch, IntegratesASineToHalfItsSquaredAmplitude) {
  for (const double bin : {40.0, 40.25, 40.5, 300.5, 500.0}) {
    const Spectrum spectrum = spectrum_of(sine(20'480, bin / 1024.0, 3.0), 100.0, 1024);
    EXPECT_NEAR(integral(spectrum), 4.5, bin == std::floor(bin) ? 1e-11 : 0.02) << bin;
  }
}

TEST(Welch, DoesNotDoubleTheBinAtHalfTheRate) {
  std::vector<double> alternating(8192);
  for (std::size_t n = 0; n < alternating.size(); ++n) alternating[n] = n % 2 == 0 ? 2.0 : -2.0;
  const Spectrum spectrum = spectrum_of(alternating, 10.0, 1024);
  EXPECT_NEAR(integral(spectrum), 4.0, 1e-12);
  EXPECT_NEAR(spectrum.one_sided_psd.back() * spectrum.window_bandwidth_hz, 4.0, 1e-12);
}

TEST(Welch, OfAConstantIsZero) {
  EXPECT_NEAR(integral(spectrum_of(std::vector<double>(9000, 9.80665), 100.0, 1024)), 0.0, 1e-25);
}

TEST(Welch, IntegratesWhiteNoiseToItsVariance) {
  const std::vector<double> x = white_noise(1'000'000, 1);
  // 4 standard deviations of the variance of a million uniform values.
  EXPECT_NEAR(integral(spectrum_of(x, 200.0, 4096)), 1.0, 4.0 * std::sqrt(0.8e-6));
}

TEST(Welch, HasTheNoiseBandwidthOfAHannWindow) {
  EXPECT_DOUBLE_EQ(spectrum_of(white_noise(5000, 1), 100.0, 1024).window_bandwidth_hz,
                   1.5 * 100.0 / 1024.0);
}

TEST(Welch, ScattersByItsDegreesOfFreedom) {
  double sum = 0.0, squares = 0.0, count = 0.0, edf = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Spectrum spectrum = spectrum_of(white_noise(8192, seed), 1.0, 512);
    edf = spectrum.edf_per_bin;
    for (std::size_t k = 2; k < 255; ++k, ++count) {
      sum += spectrum.one_sided_psd[k];
      squares += spectrum.one_sided_psd[k] * spectrum.one_sided_psd[k];
    }
  }
  const double mean = sum / count, variance = squares / count - mean * mean;
  EXPECT_NEAR(edf, 36.0 * 31 * 31 / (19.0 * 31 - 1.0), 1e-9);  // Percival & Walden, (292b)
  EXPECT_NEAR(2.0 * mean * mean / variance, edf, 0.06 * edf);
}

TEST(Welch, DoesNotDependOnHowTheSeriesIsCut) {
  const std::vector<double> x = white_noise(50'011, 5);
  const SpectrumOptions options{.rate_hz = 100.0, .segment = 256};
  const Spectrum whole = welch(x, options).value();
  for (const std::size_t piece : {1u, 127u, 129u, 5000u}) {
    SpectrumAccumulator accumulator(options);
    for (std::size_t at = 0; at < x.size(); at += piece) {
      accumulator.add(View<double>(x).subspan(at, std::min(piece, x.size() - at)));
      if (at == 20 * piece) static_cast<void>(accumulator.finish());
    }
    EXPECT_EQ(accumulator.finish().one_sided_psd, whole.one_sided_psd) << piece;
  }
}

TEST(Welch, KeepsTheLevelOfWhiteNoiseWithSamplesMissing) {
  std::vector<double> x = white_noise(400'000, 2);
  std::mt19937_64 engine(3);
  for (double& v : x) {
    v += 9.8;
    if (engine() % 20 == 0) v = nan;
  }
  EXPECT_NEAR(integral(spectrum_of(x, 100.0, 4096)), 1.0, 4.0 * std::sqrt(0.8 / 380'000));
}

TEST(Welch, PassesOverSegmentsThatAreMostlyMissing) {
  std::vector<double> x = white_noise(64 * 100, 3);
  std::fill(x.begin() + 640, x.begin() + 1280, nan);
  const Spectrum spectrum = spectrum_of(x, 1.0, 64);
  EXPECT_EQ(spectrum.averaged, 179u);  // one of the two at the edges has its peak in the gap
  EXPECT_NEAR(integral(spectrum), 1.0, 0.05);
}

TEST(Welch, TakesShorterSegmentsOfAShortSeries) {
  const Spectrum spectrum = spectrum_of(white_noise(1000, 3), 1.0, 4096);
  EXPECT_EQ(spectrum.segment, 512u);
  EXPECT_EQ(spectrum.averaged, 2u);
}

TEST(Welch, SaysWhyItCannot) {
  const std::vector<double> x = white_noise(1000, 3);
  const auto code = [](const Result<Spectrum>& result) { return result.error().code; };
  EXPECT_EQ(code(welch(x, {.rate_hz = 0.0})), Errc::invalid_argument);
  EXPECT_EQ(code(welch(x, {.rate_hz = nan})), Errc::invalid_argument);
  EXPECT_EQ(code(welch(x, {.rate_hz = 1.0, .segment = 100})), Errc::invalid_argument);
  EXPECT_EQ(code(welch(x, {.rate_hz = 1.0, .segment = 8})), Errc::invalid_argument);
  EXPECT_EQ(code(welch(View<double>(x).first(15), {.rate_hz = 1.0})), Errc::too_few_samples);
  EXPECT_EQ(code(welch(std::vector<double>(500, nan), {.rate_hz = 1.0})), Errc::too_few_samples);
}

TEST(SpectrumAccumulator, OfNothingHasNoBins) {
  const Spectrum spectrum = SpectrumAccumulator({.rate_hz = 1.0}).finish();
  EXPECT_EQ(spectrum.averaged, 0u);
  EXPECT_TRUE(spectrum.one_sided_psd.empty());
}

}  // namespace
}  // namespace proofmass::signal::spectrum_test
