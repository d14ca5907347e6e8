#include "proofmass/signal/spectral_lines.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace proofmass::signal::spectral_lines_test {
namespace {

/// Independent uniform values of variance 1: fast, and normal in the spectrum.
class White {
 public:
  explicit White(std::uint64_t seed) : engine_(seed) {}
  double operator()() {
    return std::numbers::sqrt3 * (static_cast<double>(engine_() >> 11) * 0x1p-52 - 1.0);
  }

 private:
  std::mt19937_64 engine_;
};

std::vector<double> white_noise(std::size_t n, std::uint64_t seed) {
  White white(seed);
  std::vector<double> series(n);
  for (double& x : series) x = white();
  return series;
}

std::vector<double> random_walk(std::size_t n, std::uint64_t seed) {
  std::vector<double> series = white_noise(n, seed);
  for (std::size_t i = 1; i < n; ++i) series[i] += series[i - 1];
  return series;
}

/// 1/f over five decades: first-order processes of equal variance, two to a decade.
std::vector<double> flicker_noise(std::size_t n, std::uint64_t seed) {
  White white(seed);
  std::vector<double> series(n);
  for (double corner = 0.5; corner > 1e-6; corner /= 3.2) {
    const double a = std::exp(-2.0 * std::numbers::pi * corner), b = std::sqrt(1.0 - a * a);
    double state = white();
    for (double& x : series) x += state = a * state + b * white();
  }
  return series;
}

void add_sine(std::vector<double>& series, double cycles_per_sample, double amplitude) {
  for (std::size_t i = 0; i < series.size(); ++i)
    series[i] += amplitude * std::sin(2.0 * std::numbers::pi * cycles_per_sample * double(i) + 0.7);
}

LineReport lines_of(const std::vector<double>& series,
                    double rate_hz = 1.0,
                    std::size_t segment = 4096) {
  return find_lines(welch(series, {.rate_hz = rate_hz, .segment = segment}).value());
}

template <class Make>
int false_alarms(int records, Make make) {
  int alarms = 0;
  for (int seed = 0; seed < records; ++seed)
    alarms += lines_of(make(65'536, static_cast<std::uint64_t>(seed))).lines.empty() ? 0 : 1;
  return alarms;
}

TEST(SpectralLines, AreNotFoundInWhiteNoise) {
  EXPECT_LE(false_alarms(200, white_noise), 2);
}

TEST(SpectralLines, AreNotFoundInARandomWalk) {
  EXPECT_LE(false_alarms(200, random_walk), 2);
}

TEST(SpectralLines, AreNotFoundInFlickerNoise) {
  EXPECT_LE(false_alarms(100, flicker_noise), 1);
}

TEST(SpectralLines, AreNotFoundInWhiteNoiseOfManySegments) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    EXPECT_TRUE(lines_of(white_noise(1'000'000, seed), 1.0, 256).lines.empty());
}

TEST(SpectralLines, AreNotFoundWhereAFilterBends) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<double> series = white_noise(65'536, seed);
    for (std::size_t i = 1; i < series.size(); ++i) series[i] += 0.7 * series[i - 1];
    for (std::size_t i = 1; i < series.size(); ++i) series[i] += 0.7 * series[i - 1];
    EXPECT_TRUE(lines_of(series).lines.empty()) << seed;
  }
}

TEST(SpectralLines, TellATonesFrequencyAndAmplitudeWhereverItFallsBetweenBins) {
  for (const double bin : {60.0, 60.2, 60.5, 60.8, 1500.5}) {
    std::vector<double> series = white_noise(400'000, 1);
    add_sine(series, bin / 4096.0, 0.3);
    const LineReport report = lines_of(series, 4096.0);
    ASSERT_EQ(report.lines.size(), 1u) << bin;
    const SpectralLine& line = report.lines[0];
    EXPECT_NEAR(line.frequency_hz, bin, 0.1);
    EXPECT_NEAR(line.amplitude, 0.3, 0.03 * 0.3) << bin;
    EXPECT_LT(std::abs(line.amplitude - 0.3), 4.0 * line.amplitude_std);
    EXPECT_LT(line.amplitude_std, 0.01);
    EXPECT_LT(line.low_hz, bin - 1.0);
    EXPECT_GT(line.high_hz, bin + 1.0);
    EXPECT_NEAR(report.floor.one_sided_density, std::sqrt(2.0 / 4096.0), 0.02 / 64.0);
  }
}

TEST(SpectralLines, HaveAnErrorBarThatIsTrue) {
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::vector<double> series = white_noise(65'536, seed);
    add_sine(series, 0.0513, 0.2);
    const LineReport report = lines_of(series);
    ASSERT_EQ(report.lines.size(), 1u);
    squares += std::pow((report.lines[0].amplitude - 0.2) / report.lines[0].amplitude_std, 2);
  }
  EXPECT_GT(squares / 40, 0.4);
  EXPECT_LT(squares / 40, 2.0);
}

TEST(SpectralLines, OfMainsAreItsHarmonics) {
  std::vector<double> series = white_noise(400'000, 4);
  for (const double harmonic : {1.0, 2.0, 3.0}) add_sine(series, harmonic * 50.0 / 400.0, 1.0);
  const LineReport report = lines_of(series, 400.0);
  ASSERT_EQ(report.lines.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(report.lines[i].frequency_hz, 50.0 * double(i + 1), 0.01);
    EXPECT_NEAR(report.lines[i].amplitude, 1.0, 0.03);
  }
}

TEST(SpectralLines, StandOnARedSlope) {
  std::vector<double> series = flicker_noise(400'000, 6);
  const std::vector<double> white = white_noise(series.size(), 7);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] += white[i];
  add_sine(series, 20.3 / 4096.0, 3.0);
  const LineReport report = lines_of(series, 4096.0);
  ASSERT_EQ(report.lines.size(), 1u);
  EXPECT_NEAR(report.lines[0].frequency_hz, 20.3, 0.1);
  EXPECT_NEAR(report.lines[0].amplitude, 3.0, 0.03 * 3.0);
}

TEST(SpectralLines, MayBeAsWideAsABuildingsResonance) {
  // x[i] = 2 r cos θ x[i−1] − r² x[i−2] + e: a resonance of half-power width −ln r / π, whose
  // variance is (1 + r²) / ((1 − r²) (1 − 2 r² cos 2θ + r⁴)).
  const double r = std::exp(-std::numbers::pi * 0.002), theta = 2.0 * std::numbers::pi * 0.02;
  const double variance =
      (1.0 + r * r) / ((1.0 - r * r) * (1.0 - 2.0 * r * r * std::cos(2 * theta) + r * r * r * r));
  std::vector<double> series = white_noise(1'000'000, 8);
  White shake(9);
  const double drive = 0.3 / std::sqrt(variance);
  double x1 = 0.0, x2 = 0.0;
  for (double& x : series) {
    const double next = 2.0 * r * std::cos(theta) * x1 - r * r * x2 + drive * shake();
    x2 = x1;
    x += x1 = next;
  }
  const LineReport report = lines_of(series);
  ASSERT_EQ(report.lines.size(), 1u);
  EXPECT_NEAR(report.lines[0].frequency_hz, 0.02, 0.0004);
  // Its far skirts are lost in the background.
  EXPECT_NEAR(report.lines[0].amplitude, 0.93 * 0.3 * std::numbers::sqrt2, 0.02);
  EXPECT_NEAR(report.floor.one_sided_density, std::numbers::sqrt2, 0.02);
}

TEST(SpectralLines, ScaleWithTheSeries) {
  std::vector<double> series = white_noise(65'536, 3);
  add_sine(series, 0.05, 0.5);
  const LineReport once = lines_of(series);
  for (double& x : series) x *= 4.0;
  const LineReport fourfold = lines_of(series);
  ASSERT_EQ(once.lines.size(), 1u);
  ASSERT_EQ(fourfold.lines.size(), 1u);
  EXPECT_NEAR(fourfold.lines[0].amplitude, 4.0 * once.lines[0].amplitude, 1e-9);
  EXPECT_NEAR(fourfold.lines[0].excess_db, once.lines[0].excess_db, 1e-9);
  EXPECT_NEAR(fourfold.floor.one_sided_density, 4.0 * once.floor.one_sided_density, 1e-9);
  EXPECT_EQ(fourfold.in_line, once.in_line);
}

TEST(SpectralFloor, IsTheWhiteLevelUnderARandomWalk) {
  std::vector<double> series = random_walk(400'000, 2);
  const std::vector<double> white = white_noise(series.size(), 3);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] = 0.01 * series[i] + white[i];
  const SpectralFloor floor = lines_of(series, 100.0).floor;
  EXPECT_NEAR(floor.one_sided_density, std::sqrt(2.0 / 100.0), 0.01 * std::sqrt(2.0 / 100.0));
  EXPECT_LT(std::abs(floor.one_sided_density - std::sqrt(0.02)), 5.0 * floor.std);
  EXPECT_GT(floor.low_hz, 0.3);  // random walk and white noise cross at 0.16 Hz
}

TEST(SpectralFloor, IsReadBelowAFiltersCorner) {
  std::vector<double> series = white_noise(1'000'000, 2);
  for (std::size_t i = 1; i < series.size(); ++i) series[i] = 0.3 * series[i] + 0.7 * series[i - 1];
  const SpectralFloor floor = lines_of(series).floor;
  EXPECT_LT(floor.one_sided_density, std::numbers::sqrt2);
  EXPECT_GT(floor.one_sided_density, 0.79 * std::numbers::sqrt2);
  EXPECT_LT(floor.high_hz, 0.06);
}

TEST(SpectralLines, AreNotLookedForInSilenceOrInAFewBins) {
  EXPECT_TRUE(lines_of(std::vector<double>(8192, 1.0)).lines.empty());
  EXPECT_TRUE(lines_of(white_noise(1000, 1), 1.0, 16).lines.empty());
  EXPECT_TRUE(find_lines({}).lines.empty());
}

TEST(SpectralLines, OfTheShortestSpectrumThatIsJudgedAreFinite) {
  std::vector<double> series = white_noise(4096, 1);
  add_sine(series, 0.25, 2.0);
  const LineReport report = lines_of(series, 1.0, 64);
  ASSERT_EQ(report.lines.size(), 1u);
  EXPECT_NEAR(report.lines[0].amplitude, 2.0, 0.1);
  for (const double level : report.background) EXPECT_TRUE(std::isfinite(level));
}

}  // namespace
}  // namespace proofmass::signal::spectral_lines_test
