#include "proofmass/sensor/noise_conversions.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/core/units.hpp"
#include "proofmass/sensor/datasheet.hpp"

namespace proofmass::sensor::noise_conversions_test {
namespace {

constexpr double ug = 1e-6 * standard_gravity_mps2;

TEST(NoiseConversions, ADatasheetsDensityIsRootTwoLarger) {
  const double n = two_sided_density(adxl335.noise_density_mps2_rthz[0]);
  EXPECT_NEAR(n / ug, 106.066, 1e-3);
  EXPECT_NEAR(n, 1.04e-3, 1e-6);
  EXPECT_NEAR(two_sided_density(adxl335.noise_density_mps2_rthz[2]) / ug, 212.132, 1e-3);
  EXPECT_DOUBLE_EQ(one_sided_density(n), 150.0 * ug);
}

TEST(NoiseConversions, TheFilteredRmsIsTheSameFromEitherDensity) {
  const double n = two_sided_density(150.0 * ug);
  EXPECT_DOUBLE_EQ(filtered_rms_mps2({.white_mps2_rthz = n, .bandwidth_hz = 50.0}),
                   filtered_noise_rms(150.0 * ug, 50.0));
  // The datasheet rounds π/2 to 1.6: 1.34 mg at 50 Hz.
  EXPECT_NEAR(filtered_rms_mps2({.white_mps2_rthz = n, .bandwidth_hz = 50.0}) / (1e3 * ug), 1.34,
              0.02);
}

TEST(NoiseConversions, TheFilteredRmsIsTheIntegralOfTheSpectrum) {
  // The substitution f = BW tan u makes ∫ N² / (1 + (f/BW)²) df over all f a sum of equal terms.
  const double n = 3e-3, bandwidth_hz = 7.0;
  double sum = 0.0;
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) {
    const double u = ((k + 0.5) / steps - 0.5) * std::numbers::pi;
    const double f = bandwidth_hz * std::tan(u);
    const double df = bandwidth_hz / std::pow(std::cos(u), 2) * std::numbers::pi / steps;
    sum += n * n / (1.0 + std::pow(f / bandwidth_hz, 2)) * df;
  }
  const double rms = filtered_rms_mps2({.white_mps2_rthz = n, .bandwidth_hz = bandwidth_hz});
  EXPECT_NEAR(rms * rms / sum, 1.0, 1e-9);
}

TEST(NoiseConversions, ASampleOfWhiteNoiseHasItsDensityTimesTheRate) {
  EXPECT_DOUBLE_EQ(sample_variance_m2ps4({.white_mps2_rthz = 2e-3, .rate_hz = 100.0}), 4e-4);
  // A wide filter changes nothing; after a narrow one the rate does not matter.
  EXPECT_DOUBLE_EQ(
      sample_variance_m2ps4({.white_mps2_rthz = 2e-3, .rate_hz = 100.0, .bandwidth_hz = 1600.0}),
      4e-4);
  for (const double rate_hz : {200.0, 2000.0})
    EXPECT_NEAR(
        sample_variance_m2ps4({.white_mps2_rthz = 2e-3, .rate_hz = rate_hz, .bandwidth_hz = 10.0}),
        4e-6 * std::numbers::pi * 10.0, 1e-15);
}

TEST(NoiseConversions, ASamplesVarianceIsThatOfTheSampledOnePoleFilterOrUpToAThirdMore) {
  const double n = 2e-3, rate_hz = 100.0;
  for (const double bandwidth_hz : {0.5, 5.0, 31.8, 50.0, 100.0, 1000.0}) {
    // The sampled filter is x' = φ x + w, whose density at f = 0 is the measured N².
    const double phi = std::exp(-2.0 * std::numbers::pi * bandwidth_hz / rate_hz);
    const double exact = n * n * rate_hz * (1.0 - phi) / (1.0 + phi);
    const double ratio =
        exact / sample_variance_m2ps4(
                    {.white_mps2_rthz = n, .rate_hz = rate_hz, .bandwidth_hz = bandwidth_hz});
    EXPECT_LE(ratio, 1.0 + 1e-12) << bandwidth_hz;
    EXPECT_GE(ratio, 0.7615) << bandwidth_hz;
    EXPECT_NEAR(exact, n * n * rate_hz * std::tanh(std::numbers::pi * bandwidth_hz / rate_hz),
                1e-15);
  }
}

TEST(NoiseConversions, ARandomWalkDoesNotCareIntoHowManyStepsItIsCut) {
  const double k = 1.4e-4;
  EXPECT_DOUBLE_EQ(bias_psd_m2ps5(k), 1.96e-8);
  const double once = step_variance_m2ps4({.random_walk_mps2_rts = k, .step_s = 0.1});
  EXPECT_DOUBLE_EQ(once, 1.96e-9);
  EXPECT_DOUBLE_EQ(10.0 * step_variance_m2ps4({.random_walk_mps2_rts = k, .step_s = 0.01}), once);
}

/// Allan variance of a first-order Markov process. Source: IEEE Std 952-1997, annex C.
double markov_allan_variance(const FirstOrderMarkov& markov, double tau_s) {
  const double t = markov.time_constant_s, r = tau_s / t;
  return markov.psd_m2ps5 * t * t / tau_s *
         (1.0 - (3.0 - 4.0 * std::exp(-r) + std::exp(-2.0 * r)) / (2.0 * r));
}

TEST(NoiseConversions, TheMarkovProcessPeaksWhereTheFlickerIsFlat) {
  const double b = 4e-4;
  const FirstOrderMarkov markov = markov_of_flicker({.flicker_mps2 = b, .time_constant_s = 20.0});
  double highest = 0.0, at_s = 0.0;
  for (double tau_s = 10.0; tau_s < 100.0; tau_s *= 1.0005) {
    const double variance = markov_allan_variance(markov, tau_s);
    if (variance > highest) highest = variance, at_s = tau_s;
  }
  EXPECT_NEAR(std::sqrt(highest) / (std::sqrt(flicker_plateau) * b), 1.0, 2e-4);
  EXPECT_NEAR(at_s / 20.0, 1.8926, 2e-3);
}

TEST(NoiseConversions, TheMarkovProcessHasThePublishedDensityAndVariance) {
  const double b = 4e-4, t = 20.0;
  const FirstOrderMarkov markov = markov_of_flicker({.flicker_mps2 = b, .time_constant_s = t});
  EXPECT_NEAR(markov.psd_m2ps5,
              2.0 * b * b * std::log(2.0) / (std::numbers::pi * 0.4365 * 0.4365 * t), 1e-22);
  EXPECT_NEAR(markov.psd_m2ps5, 1.8528e-8, 1e-12);
  EXPECT_NEAR(std::sqrt(markov.variance_m2ps4()), 4.3045e-4, 1e-8);
}

TEST(NoiseConversions, RoundingSpreadsATwelfthOfAStepSquaredOverTheRate) {
  const double lsb = lsb_v(2.5, 14), rate_hz = 100.0;
  const double n = rounding_density_rthz({.lsb = lsb, .rate_hz = rate_hz});
  EXPECT_NEAR(n, 8.8093e-6, 1e-9);
  EXPECT_DOUBLE_EQ(sample_variance_m2ps4({.white_mps2_rthz = n, .rate_hz = rate_hz}),
                   lsb * lsb / 12.0);
}

TEST(NoiseConversions, EachCoefficientIsReadWhereTheCurveSaysItPlainly) {
  EXPECT_DOUBLE_EQ(white_of({.tau_s = 1.0, .deviation_mps2 = 7e-4}), 7e-4);
  EXPECT_DOUBLE_EQ(random_walk_of({.tau_s = 3.0, .deviation_mps2 = 7e-4}), 7e-4);
  EXPECT_DOUBLE_EQ(quantisation_of({.tau_s = std::sqrt(3.0), .deviation_mps2 = 7e-4}), 7e-4);
  EXPECT_DOUBLE_EQ(ramp_of({.tau_s = std::sqrt(2.0), .deviation_mps2 = 7e-4}), 7e-4);
  EXPECT_NEAR(flicker_of({.tau_s = 50.0, .deviation_mps2 = 0.66428e-4}), 1e-4, 1e-9);
}

TEST(NoiseConversions, AReadingUndoesItsTermOfTheAllanVarianceAtAnyTime) {
  const double c = 3e-4;
  for (const double tau_s : {0.01, 1.0, 250.0}) {
    const auto at = [&](double variance) { return AllanReading{tau_s, std::sqrt(variance)}; };
    EXPECT_NEAR(white_of(at(c * c / tau_s)), c, 1e-18);
    EXPECT_NEAR(random_walk_of(at(c * c * tau_s / 3.0)), c, 1e-18);
    EXPECT_NEAR(flicker_of(at(2.0 * std::log(2.0) / std::numbers::pi * c * c)), c, 1e-18);
    EXPECT_NEAR(quantisation_of(at(3.0 * c * c / (tau_s * tau_s))), c, 1e-18);
    EXPECT_NEAR(ramp_of(at(c * c * tau_s * tau_s / 2.0)), c, 1e-18);
  }
}

TEST(NoiseConversions, AMinimumOfWhiteNoiseAndRandomWalkReadsAsFlickerThatIsNotThere) {
  const double n = 1e-3, k = 1e-5;
  const double tau_s = std::sqrt(3.0) * n / k;
  const double lowest = std::sqrt(n * n / tau_s + k * k * tau_s / 3.0);
  EXPECT_NEAR(lowest, std::sqrt(2.0 * n * k / std::sqrt(3.0)), 1e-12);
  EXPECT_NEAR(flicker_of({.tau_s = tau_s, .deviation_mps2 = lowest}), 1.62e-4, 1e-6);
}

TEST(FoldedDensity, IsTheFiltersVarianceSpreadOverTheBandWhereTheFilterIsWide) {
  // Samples far apart in time are independent: variance = density · rate.
  const FilteredWhite noise{.white_mps2_rthz = 2e-3, .bandwidth_hz = 1600.0};
  const double density = folded_density_rthz(noise, 100.0);
  EXPECT_NEAR(density * density * 100.0 / std::pow(filtered_rms_mps2(noise), 2), 1.0, 1e-9);
  EXPECT_NEAR(folded_density_rthz({.white_mps2_rthz = 2e-3, .bandwidth_hz = 1.0}, 1e4), 2e-3, 1e-9);
}

}  // namespace
}  // namespace proofmass::sensor::noise_conversions_test
