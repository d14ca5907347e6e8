#include "proofmass/characterise/allan/parabolic_variance.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/characterise/test_support.hpp"

namespace proofmass::characterise::parabolic_variance_test {
namespace {

using test::phase_of_white_rates;

TEST(ParabolicVariance, AgreesWithSigmaThetaOnAThousandPoints) {
  const auto x = test::nbs14_phase();
  const std::vector<double> published{0.29223188,  0.21445234,  0.15618112,
                                      0.11709746,  0.069029585, 0.049749708,
                                      0.038947417, 0.030862393, 0.012447414};
  std::size_t m = 1;
  for (const double sigma : published) {
    EXPECT_NEAR(std::sqrt(parabolic_variance(x, 1.0, m).variance), sigma,
                sigma < 0.1 ? 5.1e-10 : 5.1e-9)
        << m;
    m *= 2;
  }
}

double by_definition(const std::vector<double>& x, double tau0_s, std::size_t m) {
  const std::size_t M = x.size() - 2 * m;
  const auto length = static_cast<double>(m);
  double total = 0.0;
  for (std::size_t i = 0; i < M; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < m; ++k)
      sum += ((length - 1.0) / 2.0 - static_cast<double>(k)) * (x[i + k] - x[i + m + k]);
    total += sum * sum;
  }
  return 72.0 * total / (static_cast<double>(M) * std::pow(length, 6) * tau0_s * tau0_s);
}

class ParabolicVarianceWithAMeanRateOf : public testing::TestWithParam<double> {};

TEST_P(ParabolicVarianceWithAMeanRateOf, AgreesWithItsDefinition) {
  const auto level = phase_of_white_rates(500, 0.0, 9);
  const auto x = phase_of_white_rates(500, GetParam(), 9);
  for (const std::size_t m : {2u, 3u, 8u, 31u, 100u, 249u}) {
    const double expected = by_definition(level, 0.02, m);
    const auto found = parabolic_variance(x, 0.02, m);
    EXPECT_NEAR(found.variance, expected, (1e-12 + 1e-13 * GetParam()) * expected) << m;
    EXPECT_EQ(found.terms, 500 - 2 * m);
  }
}

INSTANTIATE_TEST_SUITE_P(Some, ParabolicVarianceWithAMeanRateOf, testing::Values(0.0, 3.0, 1e6));

TEST(ParabolicVariance, OfSingleIntervalsIsTheAllanVariance) {
  const auto x = phase_of_white_rates(100, 5.0, 2);
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < x.size(); ++i) sum += std::pow(x[i] - 2 * x[i + 1] + x[i + 2], 2);
  EXPECT_NEAR(parabolic_variance(x, 1.0, 1).variance, sum / (2.0 * 98.0), 1e-12 * sum);
}

TEST(ParabolicVariance, OfADriftIsThatOfTheAllanVarianceButForItsPublishedFactor) {
  constexpr double drift = 0.3, tau0_s = 0.01;
  std::vector<double> x(200);
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = 0.5 * drift * std::pow(tau0_s * static_cast<double>(i), 2);
  for (const double m : {2.0, 5.0, 60.0}) {
    const double allan = std::pow(drift * m * tau0_s, 2) / 2.0;
    const double factor = std::pow((m * m - 1.0) / (m * m), 2);
    EXPECT_NEAR(parabolic_variance(x, tau0_s, static_cast<std::size_t>(m)).variance, allan * factor,
                1e-10 * allan);
  }
}

TEST(ParabolicVariance, KeepsItsDigitsOnALongDriftingRecord) {
  constexpr std::size_t N = 300'001, m = 100;
  auto x = phase_of_white_rates(N, 0.0, 4);
  for (std::size_t i = 0; i < N; ++i) {
    const auto t = static_cast<double>(i);
    x[i] += 1e4 * t + 1e-4 * t * t;
  }
  const double expected = by_definition(x, 1.0, m);
  EXPECT_NEAR(parabolic_variance(x, 1.0, m).variance, expected, 1e-9 * expected);
}

}  // namespace
}  // namespace proofmass::characterise::parabolic_variance_test
