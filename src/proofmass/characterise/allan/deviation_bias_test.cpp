#include "proofmass/characterise/allan/deviation_bias.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

#include "proofmass/characterise/allan/total_variance.hpp"
#include "proofmass/characterise/noise/noise_test_support.hpp"

namespace proofmass::characterise::deviation_bias_test {
namespace {

TEST(VarianceBias, TurnsNistsUncorrectedNumbersIntoItsCorrectedOnes) {
  // The 10-point and 1000-point sets of SP 1065, white frequency noise.
  EXPECT_NEAR(64.509 / std::sqrt(variance_bias(Statistic::mtotdev, 0, 1, 10)), 75.50203, 1e-3);
  EXPECT_NEAR(64.794 / std::sqrt(variance_bias(Statistic::mtotdev, 0, 2, 10)), 75.83606, 1e-3);
  EXPECT_NEAR(74.818 / std::sqrt(variance_bias(Statistic::ttotdev, 0, 2, 10)), 87.56794, 1e-3);
  EXPECT_NEAR(5.5529e-2 / std::sqrt(variance_bias(Statistic::mtotdev, 0, 10, 1001)), 6.499161e-2,
              5e-6);
  EXPECT_NEAR(1.9547e-2 / std::sqrt(variance_bias(Statistic::mtotdev, 0, 100, 1001)), 2.287774e-2,
              5e-6);
}

TEST(VarianceBias, OfTheTotalVarianceGrowsWithTheShareOfTheRecord) {
  EXPECT_EQ(variance_bias(Statistic::totdev, 0, 100, 201), 1.0);
  // Exact expectations of the discrete statistic, 201 phases: 0.860 and 0.779.
  EXPECT_NEAR(variance_bias(Statistic::totdev, -1, 60, 201), 0.860, 0.006);
  EXPECT_NEAR(variance_bias(Statistic::totdev, -2, 60, 201), 0.779, 0.006);
}

TEST(VarianceBias, OfTheHadamardTotalVarianceStartsAtTwoSamples) {
  EXPECT_EQ(variance_bias(Statistic::htotdev, 0, 1, 10), 1.0);
  EXPECT_EQ(variance_bias(Statistic::htotdev, 0, 2, 10), 0.995);
  EXPECT_EQ(variance_bias(Statistic::htotdev, -4, 20, 1001), 0.679);
}

// Ratio of the mean of a statistic over records of white phase noise to the true variance.
double share_read(const std::function<double(View<double>)>& statistic, double true_variance) {
  constexpr unsigned records = 400;
  double sum = 0.0;
  for (unsigned seed = 0; seed < records; ++seed) sum += statistic(test::normals(257, seed));
  return sum / records / true_variance;
}

TEST(VarianceBias, InQuantisationNoiseIsWhatTheStatisticsRead) {
  for (const std::size_t m : {8U, 32U, 64U}) {
    SCOPED_TRACE(m);
    const auto tau = static_cast<double>(m);
    const double total = share_read(
        [=](View<double> x) { return total_variance(x, 1.0, m).variance; }, 3.0 / (tau * tau));
    EXPECT_NEAR(variance_bias(Statistic::totdev, 2, m, 257) / total, 1.0, 0.02);
    const double hadamard =
        share_read([=](View<double> x) { return hadamard_total_variance(x, 1.0, m).variance; },
                   20.0 / 6.0 / (tau * tau));
    EXPECT_NEAR(variance_bias(Statistic::htotdev, 2, m, 257) / hadamard, 1.0, 0.03);
  }
}

TEST(VarianceBias, OfTheo1IsWhatTheExactExpectationsGive) {
  // Allan variance at 75 τ0 over E[Theo1] at m = 100, computed from the covariance of 201 phases.
  EXPECT_EQ(variance_bias(Statistic::theo1, 0, 100, 201), 1.0);
  EXPECT_NEAR(1.0 / variance_bias(Statistic::theo1, -1, 100, 201), 0.4415 / 0.2406, 0.01);
  EXPECT_NEAR(1.0 / variance_bias(Statistic::theo1, 2, 100, 201), 3.0 / 5625.0 / 2.405e-3, 1e-4);
}

TEST(VarianceBias, IsAbsentIfNoneIsPublished) {
  for (const Statistic statistic :
       {Statistic::adev, Statistic::oadev, Statistic::mdev, Statistic::tdev, Statistic::hdev,
        Statistic::ohdev, Statistic::pdev}) {
    EXPECT_EQ(variance_bias(statistic, -2, 10, 1001), 1.0);
    EXPECT_TRUE(bias_correction(statistic).empty());
  }
  for (const Statistic statistic : {Statistic::totdev, Statistic::mtotdev, Statistic::ttotdev,
                                    Statistic::htotdev, Statistic::theo1})
    EXPECT_FALSE(bias_correction(statistic).empty());
}

}  // namespace
}  // namespace proofmass::characterise::deviation_bias_test
