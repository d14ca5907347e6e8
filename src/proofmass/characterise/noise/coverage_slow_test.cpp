#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <random>
#include <unsupported/Eigen/FFT>
#include <utility>
#include <vector>

#include "proofmass/characterise/noise_analysis.hpp"

// Coverage of limits and intervals: thousands of recordings of processes whose Allan variance is
// known exactly. Rates are at 100 Hz.
namespace proofmass::characterise::noise_coverage_slow_test {
namespace {

constexpr double rate_hz = 100.0;
constexpr double pi = std::numbers::pi;

/// Coefficients as in noise_model.hpp, in the order of `coefficients`.
struct Truth {
  double quantisation = 0.0, white = 0.0, flicker = 0.0, random_walk = 0.0, ramp = 0.0;
  [[nodiscard]] std::array<double, 5> values() const {
    return {quantisation, white, flicker, random_walk, ramp};
  }
};

enum Place : std::size_t { quantisation, white, flicker, random_walk, ramp };

std::array<const Coefficient*, 5> coefficients(const NoiseModelFit& model) {
  return {&model.quantisation, &model.white, &model.flicker, &model.random_walk, &model.ramp};
}

/// Noise of spectrum S = τ0 / (2 sin(π f τ0)) at the discrete frequencies of a period eight times
/// the recording, of which a recording is one eighth.
class Flicker {
 public:
  explicit Flicker(std::size_t samples) : samples_(samples) {
    while (period_ < 8 * samples) period_ *= 2;
  }

  [[nodiscard]] std::vector<double> draw(std::mt19937_64& random) {
    if (!spare_.empty()) return std::exchange(spare_, {});
    std::normal_distribution<double> normal;
    std::vector<std::complex<double>> spectrum(period_), series;
    for (std::size_t k = 1; k < period_; ++k) {
      const double size = std::sqrt(static_cast<double>(period_) * density(k));
      const double real = normal(random), imaginary = normal(random);
      spectrum[k] = {size * real, size * imaginary};
    }
    fourier_.inv(series, spectrum);
    // The real and imaginary parts are independent.
    std::vector<double> first(samples_);
    spare_.resize(samples_);
    for (std::size_t i = 0; i < samples_; ++i) {
      first[i] = series[i].real();
      spare_[i] = series[i].imag();
    }
    return first;
  }

  /// The sum over all discrete frequencies of S times 2 sin⁴(π f τ) / (m sin(π f τ0))².
  [[nodiscard]] double allan_variance(std::size_t m) const {
    double sum = 0.0;
    for (std::size_t k = 1; k < period_; ++k) {
      const double over_tau = std::sin(phase(k) * static_cast<double>(m));
      sum += density(k) * 2.0 * std::pow(over_tau, 4.0) /
             std::pow(static_cast<double>(m) * std::sin(phase(k)), 2.0);
    }
    return sum / static_cast<double>(period_);
  }

 private:
  [[nodiscard]] double phase(std::size_t k) const {
    return pi * static_cast<double>(k) / static_cast<double>(period_);
  }
  [[nodiscard]] double density(std::size_t k) const { return 0.5 / std::sin(phase(k)); }

  std::size_t samples_, period_ = 1;
  Eigen::FFT<double> fourier_;
  std::vector<double> spare_;
};

class Process {
 public:
  Process(const Truth& truth, std::size_t samples, unsigned seed)
      : truth_(truth), samples_(samples), flicker_(samples), random_(seed) {}

  [[nodiscard]] std::vector<double> draw() {
    std::normal_distribution<double> normal;
    std::vector<double> series(samples_, 0.0);
    if (truth_.flicker > 0.0) {
      series = flicker_.draw(random_);
      for (double& y : series) y *= truth_.flicker;
    }
    const double white = truth_.white * std::sqrt(rate_hz);
    const double step = truth_.random_walk / std::sqrt(rate_hz);
    double walk = 0.0, rounding = normal(random_);
    for (std::size_t k = 0; k < samples_; ++k) {
      const double next = normal(random_);
      walk += step * normal(random_);
      series[k] += white * normal(random_) + walk + truth_.ramp * static_cast<double>(k) / rate_hz +
                   truth_.quantisation * rate_hz * (next - rounding);
      rounding = next;
    }
    return series;
  }

  /// Exact value for the process, sample by sample.
  [[nodiscard]] double allan_deviation(std::size_t m) const {
    const auto n = static_cast<double>(m);
    const double tau_s = n / rate_hz;
    const double of_flicker =
        truth_.flicker > 0.0 ? std::pow(truth_.flicker, 2.0) * flicker_.allan_variance(m) : 0.0;
    return std::sqrt(3.0 * std::pow(truth_.quantisation / tau_s, 2.0) +
                     std::pow(truth_.white, 2.0) / tau_s + of_flicker +
                     std::pow(truth_.random_walk, 2.0) / rate_hz * (2.0 * n * n + 1.0) / (6.0 * n) +
                     0.5 * std::pow(truth_.ramp * tau_s, 2.0));
  }

  [[nodiscard]] const Truth& truth() const { return truth_; }

 private:
  Truth truth_;
  std::size_t samples_;
  Flicker flicker_;
  std::mt19937_64 random_;
};

/// Counts for one coefficient.
struct Tally {
  int covered = 0;  ///< true value within the central interval
  int bounded = 0;  ///< true value below the upper bound
  int absent = 0;   ///< not observable: value 0 with a bound
};

struct Outcome {
  int records = 0;
  std::map<std::size_t, int> covered;  ///< true value within the limits of the deviation, at each
                                       ///< m
  std::array<Tally, 5> coefficients;
};

void tally(const NoiseModelFit& model, const Truth& truth, Outcome& outcome) {
  const auto found = coefficients(model);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double value = truth.values()[k];
    Tally& seen = outcome.coefficients[k];
    const bool in = found[k]->lower_95 <= value && value <= found[k]->upper_two_sided_95;
    const bool none = found[k]->verdict == Verdict::not_observable;
    seen.covered += in ? 1 : 0;
    seen.bounded += value <= found[k]->upper_95 ? 1 : 0;
    seen.absent += none && found[k]->value == 0.0 && found[k]->upper_95 > 0.0 ? 1 : 0;
  }
}

Outcome analyse(Process process, int records) {
  const NoiseOptions options{
      .rate_hz = rate_hz, .taus = {.kind = TauGrid::Kind::octave}, .confidence = 0.95};
  Outcome outcome{.records = records, .covered = {}, .coefficients = {}};
  std::map<std::size_t, double> truth;
  for (int record = 0; record < records; ++record) {
    const std::vector<double> series = process.draw();
    const NoiseAnalysis analysis = analyse_noise(View<double>(series), options).value();
    for (const DeviationPoint& point : analysis.deviation.points) {
      if (!truth.contains(point.m)) truth[point.m] = process.allan_deviation(point.m);
      const bool in = point.lower <= truth[point.m] && truth[point.m] <= point.upper;
      outcome.covered[point.m] += in ? 1 : 0;
    }
    tally(analysis.model, process.truth(), outcome);
  }
  return outcome;
}

/// Checks that a fraction is within [low, high] up to three standard deviations of that many
/// trials.
void expect_share(int count, int trials, double low, double high) {
  const double share = static_cast<double>(count) / trials;
  const auto scatter = [&](double p) { return 3.0 * std::sqrt(p * (1.0 - p) / trials); };
  EXPECT_GE(share, low - scatter(low));
  EXPECT_LE(share, high + scatter(high));
}

void expect_limits_cover(const Outcome& outcome, std::size_t samples) {
  EXPECT_EQ(outcome.covered.rbegin()->first, samples / 4);
  int in_all = 0;
  for (const auto& [m, covered] : outcome.covered) {
    SCOPED_TRACE(testing::Message() << samples << " samples, m = " << m);
    expect_share(covered, outcome.records, 0.93, 0.97);
    in_all += covered;
  }
  // The points of one record are correlated: the number of independent trials is that of the
  // records.
  const double factors = static_cast<double>(outcome.covered.size());
  SCOPED_TRACE(testing::Message() << samples << " samples, all m");
  expect_share(static_cast<int>(in_all / factors), outcome.records, 0.945, 0.96);
}

void expect_intervals_cover(const Outcome& outcome, const Truth& truth) {
  for (std::size_t k = 0; k < outcome.coefficients.size(); ++k) {
    SCOPED_TRACE(testing::Message() << "coefficient " << k << " of " << truth.values()[k]);
    const Tally& tally = outcome.coefficients[k];
    // For an absent term the interval starts at 0 unless it is mistaken for another. A ramp is
    // confused with an unobservable random walk, and its interval is wide if it is absent.
    const bool there = truth.values()[k] > 0.0 && k != ramp;
    expect_share(tally.covered, outcome.records, 0.93, there ? 0.975 : 1.0);
    expect_share(tally.bounded, outcome.records, 0.93, there ? 0.97 : 1.0);
  }
}

void expect_covered(const Truth& truth, unsigned seed) {
  for (const std::size_t samples : {1024U, 4096U}) {
    const Outcome outcome = analyse({truth, samples, seed++}, 1500);
    expect_limits_cover(outcome, samples);
    expect_intervals_cover(outcome, truth);
  }
}

TEST(NoiseCoverage, OfWhiteNoiseIsWhatLimitsAndIntervalsSay) {
  expect_covered({.white = 1.0}, 11);
}

TEST(NoiseCoverage, OfFlickerIsWhatLimitsAndIntervalsSay) {
  expect_covered({.flicker = 1.0}, 21);
}

TEST(NoiseCoverage, OfARandomWalkIsWhatLimitsAndIntervalsSay) {
  expect_covered({.random_walk = 1.0}, 31);
}

TEST(NoiseCoverage, OfMixedNoiseIsWhatIntervalsSay) {
  struct Mixture {
    Truth truth;
    std::size_t samples;
    int records;
  };
  const std::vector<Mixture> mixtures = {
      {{.white = 1.0, .random_walk = 0.5}, 20'000, 1000},
      {{.white = 0.3, .flicker = 1.0}, 4000, 1500},
      {{.quantisation = 0.03, .white = 1.0}, 4000, 1500},
      {{.white = 1.0, .ramp = 0.3}, 4000, 1500},
  };
  unsigned seed = 41;
  for (const auto& [truth, samples, records] : mixtures)
    expect_intervals_cover(analyse({truth, samples, seed++}, records), truth);
}

TEST(NoiseCoverage, OfTermsBelowWhiteNoiseIsThatOfTheirBounds) {
  // Each is identified in fewer than half of the records.
  const Truth rounded{.quantisation = 0.02, .white = 1.0};
  const Truth drifting{.white = 1.0, .ramp = 0.025};
  for (const Truth& truth : {rounded, drifting}) {
    const Outcome outcome = analyse({truth, 4000, 51}, 1500);
    const std::size_t weak = truth.ramp > 0.0 ? ramp : quantisation;
    EXPECT_GT(outcome.coefficients[weak].absent, outcome.records / 2);
    expect_share(outcome.coefficients[weak].bounded, outcome.records, 0.95, 1.0);
  }
}

TEST(NoiseCoverage, OfWhiteNoiseAloneFindsNoOtherTerm) {
  const Outcome outcome = analyse({{.white = 1.0}, 2000, 61}, 1500);
  EXPECT_EQ(outcome.coefficients[white].absent, 0);
  for (const Place place : {quantisation, flicker, random_walk, ramp}) {
    SCOPED_TRACE(testing::Message() << "coefficient " << place);
    expect_share(outcome.coefficients[place].absent, outcome.records, 0.98, 1.0);
    EXPECT_EQ(outcome.coefficients[place].bounded, outcome.records);
  }
}

}  // namespace
}  // namespace proofmass::characterise::noise_coverage_slow_test
