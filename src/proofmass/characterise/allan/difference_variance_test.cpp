#include "proofmass/characterise/allan/difference_variance.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <random>

namespace proofmass::characterise::difference_variance_test {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> white(std::size_t n, double mean = 0.0, unsigned seed = 1) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal(mean, 1.0);
  std::vector<double> y(n);
  for (double& v : y) v = normal(rng);
  return y;
}

std::vector<double> random_walk(std::size_t n) {
  std::vector<double> y = white(n);
  std::partial_sum(y.begin(), y.end(), y.begin());
  return y;
}

std::vector<PhaseVariance> variances(Statistic statistic,
                                     View<double> y,
                                     const std::vector<std::size_t>& factors,
                                     std::size_t overlap = DifferenceVariances::full_overlap) {
  DifferenceVariances all(statistic, factors, overlap);
  all.add(y);
  return all.finish();
}

// Average of m samples from `first` on, in long double.
long double average(View<double> y, std::size_t first, std::size_t m) {
  long double sum = 0.0L;
  for (std::size_t k = 0; k < m; ++k) sum += static_cast<long double>(y[first + k]);
  return sum / static_cast<long double>(m);
}

// Definitions in terms of averages of adjacent samples, implemented literally.
double by_definition(Statistic statistic, View<double> y, std::size_t m) {
  const bool third = statistic == Statistic::hdev || statistic == Statistic::ohdev;
  const bool overlap = statistic != Statistic::adev && statistic != Statistic::hdev;
  long double sum = 0.0L;
  std::size_t terms = 0;
  for (std::size_t k = 0; k + (third ? 3 : 2) * m <= y.size(); k += overlap ? 1 : m) {
    long double z = average(y, k + m, m) - average(y, k, m);
    if (third) z = average(y, k + 2 * m, m) - average(y, k + m, m) - z;
    sum += z * z;
    ++terms;
  }
  return static_cast<double>(sum / static_cast<long double>((third ? 6 : 2) * terms));
}

// SP1065, equation 13: the mean of m neighbouring second differences of the phase, squared.
double modified_by_definition(View<double> y, std::size_t m) {
  long double sum = 0.0L;
  std::size_t terms = 0;
  for (std::size_t k = 0; k + 3 * m <= y.size() + 1; ++k, ++terms) {
    long double z = 0.0L;
    for (std::size_t i = k; i < k + m; ++i) z += average(y, i + m, m) - average(y, i, m);
    sum += z * z / static_cast<long double>(m * m);
  }
  return static_cast<double>(sum / static_cast<long double>(2 * terms));
}

TEST(DifferenceVariances, AreTheirDefinitions) {
  for (const auto& y : {white(300, 1e4), random_walk(300)}) {
    const std::vector<std::size_t> factors{1, 2, 3, 7, 31, 32, 64, 65, 96};
    for (const Statistic statistic :
         {Statistic::adev, Statistic::oadev, Statistic::hdev, Statistic::ohdev}) {
      const auto found = variances(statistic, y, factors);
      for (std::size_t k = 0; k + 2 < factors.size(); ++k) {
        EXPECT_NEAR(found[k].variance / by_definition(statistic, y, factors[k]), 1.0, 1e-9)
            << name_of(statistic) << " m = " << factors[k];
      }
    }
    const auto found = variances(Statistic::mdev, y, factors);
    for (std::size_t k = 0; k < factors.size(); ++k) {
      EXPECT_NEAR(found[k].variance / modified_by_definition(y, factors[k]), 1.0, 1e-8)
          << "m = " << factors[k];
    }
  }
}

TEST(DifferenceVariances, OfTheNistTenPointSetAreThePublishedFigures) {
  const std::vector<double> y{892, 809, 823, 798, 671, 644, 883, 903, 677};
  const auto deviation = [&](Statistic statistic, std::size_t m) {
    return std::sqrt(variances(statistic, y, {m}).front().variance);
  };
  EXPECT_NEAR(deviation(Statistic::adev, 1), 91.22945, 5e-6);
  EXPECT_NEAR(deviation(Statistic::adev, 2), 115.8082, 5e-5);
  EXPECT_NEAR(deviation(Statistic::oadev, 2), 85.95287, 5e-6);
  EXPECT_NEAR(deviation(Statistic::mdev, 2), 74.78849, 5e-6);
  EXPECT_NEAR(deviation(Statistic::tdev, 2) * 2.0 / std::sqrt(3.0), 86.35831, 5e-6);
  EXPECT_NEAR(deviation(Statistic::hdev, 1), 70.80608, 1e-5);
  EXPECT_NEAR(deviation(Statistic::hdev, 2), 116.7980, 5e-5);
  EXPECT_NEAR(deviation(Statistic::ohdev, 2), 85.61487, 5e-6);
}

TEST(DifferenceVariances, DoNotDependOnHowTheSamplesArrive) {
  const auto y = random_walk(200'000);
  const std::vector<std::size_t> factors{1, 5, 48, 1000, 20'000};
  for (const Statistic statistic : {Statistic::oadev, Statistic::mdev, Statistic::adev}) {
    const auto whole = variances(statistic, y, factors);
    DifferenceVariances pieces(statistic, factors, DifferenceVariances::full_overlap);
    std::size_t from = 0;
    for (std::size_t size = 1; from < y.size(); size = size * 3 % 10'007 + 1) {
      const auto part = View<double>(y).subspan(from, std::min(size, y.size() - from));
      pieces.add(part);
      from += part.size();
    }
    const auto found = pieces.finish();
    for (std::size_t k = 0; k < factors.size(); ++k) {
      EXPECT_EQ(found[k].terms, whole[k].terms);
      EXPECT_NEAR(found[k].variance / whole[k].variance, 1.0, 1e-6);
    }
  }
}

TEST(DifferenceVariances, StartATermAtEachDecimatedPlace) {
  const auto y = white(10'000);
  const auto found = variances(Statistic::oadev, y, {1, 63, 64, 1024}, 32);
  EXPECT_EQ(found[0].terms, 9'999U);
  EXPECT_EQ(found[1].terms, 10'001U - 126U);
  EXPECT_EQ(found[2].terms, (10'000U - 128U) / 2 + 1);
  EXPECT_EQ(found[3].terms, (10'000U - 2048U) / 32 + 1);
}

TEST(DifferenceVariances, LoseAlmostNoPrecisionByDecimation) {
  const std::vector<std::size_t> factors{64, 512, 4096};
  for (const auto& y : {white(200'000), random_walk(200'000)}) {
    for (const Statistic statistic : {Statistic::oadev, Statistic::mdev, Statistic::ohdev}) {
      const auto full = variances(statistic, y, factors),
                 thin = variances(statistic, y, factors, 32);
      for (std::size_t k = 0; k < factors.size(); ++k) {
        EXPECT_NEAR(std::sqrt(thin[k].variance / full[k].variance), 1.0, 0.01)
            << name_of(statistic);
      }
    }
  }
}

TEST(DifferenceVariances, OfALongRandomWalkStayExactAtTheShortestTau) {
  // The double integral of a random walk grows with its length to the power 2.5.
  const auto y = random_walk(2'000'000);
  const auto modified = variances(Statistic::mdev, y, {1, 32}),
             plain = variances(Statistic::oadev, y, {1});
  EXPECT_NEAR(modified[0].variance / plain[0].variance, 1.0, 1e-6);
  EXPECT_NEAR(modified[0].variance, 0.5, 0.002);
}

TEST(DifferenceVariances, CountOnlyCompleteTermsWhereTheyAreShort) {
  auto y = white(100);
  y[50] = missing;
  const auto found = variances(Statistic::oadev, y, {1, 7, 8});
  EXPECT_EQ(found[0].terms, 99U - 2U);
  EXPECT_EQ(found[1].terms, 101U - 14U - 14U);
  EXPECT_EQ(found[2].terms, 101U - 16U) << "one in sixteen may be missing";
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < 100; ++k) {
    if (k != 49 && k != 50) sum += std::pow(y[k + 1] - y[k], 2) / 2.0;
  }
  EXPECT_NEAR(found[0].variance, sum / 97.0, 1e-12);
}

TEST(DifferenceVariances, StayWhereTheyAreIfOneInAHundredIsMissing) {
  auto y = white(200'000, 9.8);
  const std::vector<std::size_t> factors{1, 8, 64, 512, 4096};
  const auto complete = variances(Statistic::oadev, y, factors);
  std::mt19937_64 rng(3);
  for (std::size_t k = 0; k < y.size() / 100; ++k) y[rng() % y.size()] = missing;
  const auto found = variances(Statistic::oadev, y, factors);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    EXPECT_NEAR(std::sqrt(found[k].variance / complete[k].variance), 1.0, 0.02) << factors[k];
    EXPECT_GT(found[k].terms, complete[k].terms * 8 / 10);
  }
}

TEST(DifferenceVariances, PassOverALongGap) {
  auto y = white(50'000, 5.0);
  for (std::size_t k = 20'000; k < 25'000; ++k) y[k] = missing;
  const auto found = variances(Statistic::oadev, y, {1, 16, 256, 4096});
  for (std::size_t k = 0; k < 3; ++k) {
    const double m = std::pow(16.0, static_cast<double>(k));
    EXPECT_NEAR(found[k].variance * m, 1.0, 0.15) << m;
  }
  EXPECT_LT(found[3].terms, 30'000U);
  y.assign(100, missing);
  EXPECT_EQ(variances(Statistic::oadev, y, {1})[0].terms, 0U);
}

TEST(DifferenceVariances, IgnoreWhatIsMissingAtTheEnds) {
  auto y = white(1000);
  const auto inner = variances(Statistic::mdev, y, {1, 10, 100});
  y.insert(y.begin(), 7, missing);
  y.insert(y.end(), 9, missing);
  const auto found = variances(Statistic::mdev, y, {1, 10, 100});
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(found[k].terms, inner[k].terms);
    EXPECT_NEAR(found[k].variance / inner[k].variance, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace proofmass::characterise::difference_variance_test
