#include "proofmass/characterise/noise/term_spectra.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

namespace proofmass::characterise::term_spectra_test {
namespace {

using std::numbers::pi;
using Density = std::function<double(double)>;

constexpr double rate_hz = 100.0;
constexpr double tau0_s = 1.0 / rate_hz;

Density of(Term term, std::size_t block = 1) {
  return [=](double f) { return term_density(term, f, {rate_hz, block}); };
}

Density of_relaxation(double time_constant_s, std::size_t block = 1) {
  return [=](double f) { return relaxation_density(time_constant_s, f, {rate_hz, block}); };
}

double square(double x) {
  return x * x;
}

/// σ²(m h) of a series of step h and density S: ∫ S(f) 2 sin⁴(π f m h) / (m sin(π f h))² df over
/// |f| < 1/(2h), by the midpoint rule, which is exact for trigonometric polynomials.
double allan_variance(const Density& density, double step_s, std::size_t m, std::size_t points) {
  double sum = 0.0;
  for (std::size_t k = 0; k < points; ++k) {
    const double f = (static_cast<double>(k) + 0.5) / (2.0 * step_s * static_cast<double>(points));
    const auto factor = static_cast<double>(m);
    const double transfer = 2.0 * square(square(std::sin(pi * f * factor * step_s))) /
                            square(factor * std::sin(pi * f * step_s));
    sum += density(f) * transfer;
  }
  return sum / (static_cast<double>(points) * step_s);
}

TEST(TermDensity, OfQuantisationIntegratesToThreeOverTauSquared) {
  for (const std::size_t m : {1U, 2U, 5U, 32U}) {
    const double tau_s = static_cast<double>(m) * tau0_s;
    EXPECT_NEAR(allan_variance(of(Term::quantisation), tau0_s, m, 500) * square(tau_s), 3.0, 1e-9);
  }
}

TEST(TermDensity, OfWhiteNoiseIntegratesToOneOverTau) {
  for (const std::size_t m : {1U, 2U, 5U, 32U}) {
    const double tau_s = static_cast<double>(m) * tau0_s;
    EXPECT_NEAR(allan_variance(of(Term::white), tau0_s, m, 500) * tau_s, 1.0, 1e-9);
  }
}

TEST(TermDensity, OfARandomWalkOfStepsIntegratesToItsAllanVariance) {
  for (const std::size_t m : {1U, 2U, 5U, 32U}) {
    const auto factor = static_cast<double>(m);
    const double exact = tau0_s * (2.0 * factor * factor + 1.0) / (6.0 * factor);
    EXPECT_NEAR(allan_variance(of(Term::random_walk), tau0_s, m, 500) / exact, 1.0, 1e-9);
  }
  EXPECT_NEAR(allan_variance(of(Term::random_walk), tau0_s, 100, 1000), 1.0 / 3.0, 1e-4);
}

TEST(TermDensity, OfFlickerIntegratesToTwoLnTwoOverPi) {
  const double exact = 2.0 * std::numbers::ln2 / pi;
  EXPECT_NEAR(allan_variance(of(Term::flicker), tau0_s, 64, 200'000) / exact, 1.0, 1e-3);
  EXPECT_NEAR(allan_variance(of(Term::flicker), tau0_s, 256, 200'000) / exact, 1.0, 1e-4);
}

TEST(RelaxationDensity, IntegratesToTheAllanVarianceOfExponentialCorrelation) {
  for (const double time_constant_s : {0.003, 0.05, 0.7}) {
    const double phi = std::exp(-tau0_s / time_constant_s);
    const double variance = rate_hz * (1.0 - phi) / (1.0 + phi);
    for (const std::size_t m : {1U, 3U, 40U}) {
      // From the autocovariance: variance of the mean over m samples, and its covariance with the
      // next mean.
      double own = 0.0, next = 0.0;
      for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < m; ++j) {
          own += std::pow(phi, std::abs(static_cast<double>(i) - static_cast<double>(j)));
          next += std::pow(phi, static_cast<double>(m + j - i));
        }
      }
      const double exact = variance * (own - next) / square(static_cast<double>(m));
      EXPECT_NEAR(allan_variance(of_relaxation(time_constant_s), tau0_s, m, 50'000) / exact, 1.0,
                  1e-9)
          << time_constant_s << " s, m = " << m;
    }
  }
}

TEST(RelaxationDensity, OfManySamplesToATimeConstantIsThatOfIeee952) {
  const double T = 0.7;
  for (const std::size_t m : {20U, 70U, 300U}) {
    const double x = static_cast<double>(m) * tau0_s / T;
    const double exact =
        (1.0 - (3.0 - 4.0 * std::exp(-x) + std::exp(-2.0 * x)) / (2.0 * x)) / (x * T);
    EXPECT_NEAR(allan_variance(of_relaxation(T), tau0_s, m, 50'000) / exact, 1.0, 3e-3);
  }
}

TEST(TermDensity, TendsToTheContinuousFormulaAtLowFrequency) {
  const double f = 0.01, omega = 2.0 * pi * f;
  EXPECT_NEAR(of(Term::quantisation)(f) / (square(omega) * tau0_s), 1.0, 1e-6);
  EXPECT_EQ(of(Term::white)(f), 1.0);
  EXPECT_NEAR(of(Term::flicker)(f) * omega, 1.0, 1e-6);
  EXPECT_NEAR(of(Term::random_walk)(f) * square(omega), 1.0, 1e-6);
  for (const double T : {0.1, 10.0, 1000.0})
    EXPECT_NEAR(of_relaxation(T)(f) * (1.0 + square(omega * T)), 1.0, 1e-4) << T;
}

TEST(TermDensity, OfBlocksTendsToTheSameAtLowFrequency) {
  const double f = 0.001;
  for (const std::size_t block : {2U, 16U, 128U}) {
    EXPECT_NEAR(of(Term::flicker, block)(f) / of(Term::flicker)(f), 1.0, 1e-3) << block;
    EXPECT_NEAR(of(Term::random_walk, block)(f) / of(Term::random_walk)(f), 1.0, 1e-4) << block;
    EXPECT_NEAR(of_relaxation(2.0, block)(f) / of_relaxation(2.0)(f), 1.0, 1e-3) << block;
    EXPECT_EQ(of(Term::white, block)(f), 1.0);
  }
}

TEST(RelaxationDensity, IsOneAtFrequencyZeroAndWhiteWithoutATimeConstant) {
  for (const double T : {1e-3, 0.1, 1.0, 100.0})
    EXPECT_NEAR(relaxation_density(T, 1e-9, {rate_hz, 1}), 1.0, 1e-5) << T;
  for (const double f : {0.1, 10.0, 50.0})
    EXPECT_NEAR(relaxation_density(1e-4, f, {rate_hz, 1}), 1.0, 1e-12) << f;
}

TEST(RelaxationDensity, TimesTheSquareOfALongTimeConstantIsARandomWalk) {
  const double T = 2e3;
  for (const std::size_t block : {1U, 2U, 128U}) {
    for (const double share : {0.3, 0.7, 1.0}) {
      const double f = share * rate_hz / (2.0 * static_cast<double>(block));
      EXPECT_NEAR(T * T * relaxation_density(T, f, {rate_hz, block}) /
                      term_density(Term::random_walk, f, {rate_hz, block}),
                  1.0, 1e-4)
          << block << " " << f;
    }
  }
}

/// Density of the means over D samples, from that of the samples: Σ S |transfer|² over all aliases.
double aliased(const Density& samples, double f, std::size_t block) {
  const auto D = static_cast<double>(block);
  double sum = 0.0;
  for (std::size_t j = 0; j < block; ++j) {
    const double alias = f + static_cast<double>(j) * rate_hz / D;
    const double folded = std::min(alias, rate_hz - alias);
    const double phase = pi * folded * tau0_s;
    sum += samples(folded) * square(std::sin(D * phase) / (D * std::sin(phase)));
  }
  return sum;
}

TEST(TermDensity, OfMeansOverBlocksIsTheSumOfItsAliases) {
  for (const std::size_t block : {2U, 3U, 16U, 128U}) {
    for (const double share : {0.003, 0.1, 0.5, 0.97}) {
      const double f = share * rate_hz / (2.0 * static_cast<double>(block));
      SCOPED_TRACE(testing::Message() << "block " << block << ", f " << f);
      EXPECT_NEAR(of(Term::quantisation, block)(f) / aliased(of(Term::quantisation), f, block), 1.0,
                  1e-9);
      EXPECT_NEAR(of(Term::white, block)(f) / aliased(of(Term::white), f, block), 1.0, 1e-9);
      EXPECT_NEAR(of(Term::random_walk, block)(f) / aliased(of(Term::random_walk), f, block), 1.0,
                  1e-9);
      for (const double T : {0.002, 0.1, 5.0})
        EXPECT_NEAR(of_relaxation(T, block)(f) / aliased(of_relaxation(T), f, block), 1.0, 1e-8);
    }
  }
}

TEST(TermDensity, OfFlickerOverBlocksIsTheSumOfItsAliasesWhereBlocksAreUsed) {
  for (const std::size_t block : {2U, 4U, 16U, 128U}) {
    for (const double share : {0.003, 0.1, 0.5}) {
      const double f = share * rate_hz / (2.0 * static_cast<double>(block));
      EXPECT_NEAR(of(Term::flicker, block)(f) / aliased(of(Term::flicker), f, block), 1.0, 2e-3)
          << "block " << block << ", share " << share;
    }
  }
}

// Differences of a random walk's means are sums of its steps: their autocovariance by counting.
TEST(TermDensity, OfMeansOfARandomWalkIsTheTransformOfTheirDifferences) {
  for (const std::size_t block : {1U, 2U, 7U, 64U}) {
    const auto D = static_cast<double>(block);
    std::vector<double> weight;  // of each step in the difference of two adjacent means
    for (std::size_t k = 1; k < 2 * block; ++k)
      weight.push_back(static_cast<double>(std::min(k, 2 * block - k)) / D);
    double own = 0.0, next = 0.0;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      own += square(weight[k]);
      if (k + block < weight.size()) next += weight[k] * weight[k + block];
    }
    const double step_s = D * tau0_s, f = 0.2 / step_s, omega = 2.0 * pi * f * step_s;
    const double differences = step_s * tau0_s * (own + 2.0 * next * std::cos(omega));
    EXPECT_NEAR(of(Term::random_walk, block)(f) * square(2.0 * std::sin(0.5 * omega)) / differences,
                1.0, 1e-12)
        << block;
  }
}

TEST(TermDensity, OfBlocksGivesTheAllanVarianceThatTheSamplesGive) {
  const std::size_t block = 8, m = 6;
  const double step_s = static_cast<double>(block) * tau0_s;
  for (const Term term : {Term::quantisation, Term::white, Term::random_walk})
    EXPECT_NEAR(allan_variance(of(term, block), step_s, m, 1000) /
                    allan_variance(of(term), tau0_s, block * m, 1000),
                1.0, 1e-9)
        << static_cast<int>(term);
  EXPECT_NEAR(allan_variance(of_relaxation(0.3, block), step_s, m, 20'000) /
                  allan_variance(of_relaxation(0.3), tau0_s, block * m, 20'000),
              1.0, 1e-9);
  EXPECT_NEAR(allan_variance(of(Term::flicker, block), step_s, m, 50'000) /
                  allan_variance(of(Term::flicker), tau0_s, block * m, 50'000),
              1.0, 1e-3);
}

TEST(TermDensityDeathTest, WantsAFrequencyAboveZeroAndATimeConstantForMarkovNoise) {
  EXPECT_DEATH((void)term_density(Term::white, 0.0, {rate_hz, 1}), "frequency_hz");
  EXPECT_DEATH((void)term_density(Term::markov, 1.0, {rate_hz, 1}), "markov");
}

TEST(SineAllanVariance, IsThatOfASampledSine) {
  const double f = 0.5, amplitude = 2.0;
  for (const double tau_s : {0.3, 1.0, 1.7}) {
    double sum = 0.0;
    constexpr int starts = 1000, inner = 2000;
    for (int s = 0; s < starts; ++s) {
      double first = 0.0, second = 0.0;
      for (int k = 0; k < inner; ++k) {
        const double t = s / (starts * f) + (k + 0.5) / inner * tau_s;
        first += amplitude * std::sin(2.0 * pi * f * t) / inner;
        second += amplitude * std::sin(2.0 * pi * f * (t + tau_s)) / inner;
      }
      sum += 0.5 * square(second - first) / starts;
    }
    EXPECT_NEAR(sine_allan_variance(amplitude, f, tau_s), sum, 1e-5 * square(amplitude)) << tau_s;
  }
}

TEST(RelaxationAllanVariance, OfOneSampleIsHalfTheMeanSquareStep) {
  // Adjacent values of variance 1 have correlation φ; the density at zero is τ0 (1 + φ)/(1 − φ).
  const double T = 0.03, hz = 100.0, phi = std::exp(-1.0 / (T * hz));
  EXPECT_NEAR(relaxation_allan_variance(T, 1.0, hz), hz * (1.0 - phi) * (1.0 - phi) / (1.0 + phi),
              1e-10);
}

TEST(RelaxationAllanVariance, OfManySamplesIsThatOfWhiteNoiseOrOfARandomWalk) {
  EXPECT_NEAR(relaxation_allan_variance(0.01, 1e5, 100.0) * 1e3, 1.0, 1e-4);  // σ² τ for density 1
  const double T = 1e4, tau_s = 10.0;  // far below T: a random walk with K = 1/T
  EXPECT_NEAR(relaxation_allan_variance(T, tau_s * 100.0, 100.0) / (tau_s / (3.0 * T * T)), 1.0,
              2e-3);
}

}  // namespace
}  // namespace proofmass::characterise::term_spectra_test
