#include "proofmass/characterise/allan/averaging_times.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

namespace proofmass::characterise::averaging_times_test {
namespace {

using Factors = std::vector<std::size_t>;
using Kind = TauGrid::Kind;

Factors factors(Kind kind, Statistic statistic, std::size_t samples, double stop_ratio = 0.0) {
  return averaging_factors({.kind = kind, .stop_ratio = stop_ratio}, statistic, samples, 0.01);
}

Factors given(std::vector<double> times_s, Statistic statistic, std::size_t samples) {
  return averaging_factors({.kind = Kind::given, .times_s = std::move(times_s)}, statistic, samples,
                           0.01);
}

TEST(AveragingFactors, OfOctavesAreThePowersOfTwoUpToAQuarterOfTheRecord) {
  EXPECT_EQ(factors(Kind::octave, Statistic::oadev, 1000), (Factors{1, 2, 4, 8, 16, 32, 64, 128}));
  EXPECT_EQ(factors(Kind::octave, Statistic::oadev, 1024).back(), 256U);
  EXPECT_EQ(factors(Kind::octave, Statistic::oadev, 1023).back(), 128U);
}

TEST(AveragingFactors, OfDecadesAreOneTwoFourAsInPublishedTables) {
  EXPECT_EQ(factors(Kind::decade, Statistic::adev, 1000), (Factors{1, 2, 4, 10, 20, 40, 100, 200}));
  EXPECT_EQ(factors(Kind::decade, Statistic::adev, 1600).back(), 400U);
}

TEST(AveragingFactors, OfAllAreEveryOne) {
  Factors expected(25);
  std::iota(expected.begin(), expected.end(), std::size_t{1});
  EXPECT_EQ(factors(Kind::all, Statistic::oadev, 100), expected);
}

TEST(AveragingFactors, PerDecadeAreWithinOneInThirtyTwoOfEvenAndCanBeDecimated) {
  constexpr int count = 16;
  const std::size_t samples = 10'000'000;
  const Factors m = averaging_factors({.kind = Kind::per_decade, .per_decade = count},
                                      Statistic::oadev, samples, 0.01);
  ASSERT_TRUE(std::is_sorted(m.begin(), m.end()));
  EXPECT_EQ(m.front(), 1U);
  EXPECT_EQ(std::adjacent_find(m.begin(), m.end()), m.end());
  for (const std::size_t factor : m) {
    EXPECT_LE(static_cast<int>(std::bit_width(factor)) - std::countr_zero(factor), 6) << factor;
    const double even = count * std::log10(static_cast<double>(factor));
    const double nearest = std::pow(10.0, std::round(even) / count);
    if (factor >= 32) {
      EXPECT_NEAR(static_cast<double>(factor) / nearest, 1.0, 1.0 / 32.0 + 1e-9) << factor;
    }
  }
  const auto above = static_cast<double>(std::count_if(
      m.begin(), m.end(), [](std::size_t factor) { return factor >= 100 && factor < 100'000; }));
  EXPECT_NEAR(above, 3 * count, 1.0);
}

TEST(AveragingFactors, PerDecadeAreAsManyAsAskedFor) {
  const Factors m = averaging_factors({.kind = Kind::per_decade, .per_decade = 1}, Statistic::oadev,
                                      100'000, 0.01);
  EXPECT_EQ(m, (Factors{1, 10, 100, 992, 10240}));
}

TEST(AveragingFactors, GivenAreThoseOfTheTimesRoundedSortedAndOnce) {
  EXPECT_EQ(given({1.0, 0.01, 0.104, 0.096, 0.1, 0.5}, Statistic::oadev, 1000),
            (Factors{1, 10, 50, 100}));
}

TEST(AveragingFactors, GivenReachToTheLastTermWhateverTheStopRatio) {
  EXPECT_EQ(given({0.05, 0.06}, Statistic::oadev, 10), (Factors{5}));
  EXPECT_EQ(given({0.03, 0.04}, Statistic::mdev, 10), (Factors{3}));
  EXPECT_EQ(given({0.03, 0.04}, Statistic::ohdev, 10), (Factors{3}));
  EXPECT_EQ(given({0.09, 0.1}, Statistic::totdev, 10), (Factors{9}));
  EXPECT_EQ(given({0.1, 0.12}, Statistic::theo1, 10), (Factors{10}));
}

TEST(AveragingFactors, ThatAreNotTimesAreOmitted) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(given({nan, infinite, -infinite, -1.0, 0.0, 0.004, 1e300, 0.02}, Statistic::oadev, 100),
            (Factors{2}));
  EXPECT_TRUE(given({}, Statistic::oadev, 100).empty());
}

TEST(AveragingFactors, StopWhereTheStatisticDoes) {
  EXPECT_EQ(factors(Kind::all, Statistic::oadev, 120).back(), 30U);
  EXPECT_EQ(factors(Kind::all, Statistic::totdev, 120).back(), 60U);
  EXPECT_EQ(factors(Kind::all, Statistic::mtotdev, 120).back(), 40U);
  EXPECT_EQ(factors(Kind::all, Statistic::ttotdev, 120).back(), 40U);
  EXPECT_EQ(factors(Kind::all, Statistic::htotdev, 120).back(), 40U);
  EXPECT_EQ(factors(Kind::all, Statistic::theo1, 120).back(), 120U);
}

TEST(AveragingFactors, StopAtTheRatioAskedForButNeverBeyondTheLastTerm) {
  EXPECT_EQ(factors(Kind::all, Statistic::oadev, 120, 10.0).back(), 12U);
  EXPECT_EQ(factors(Kind::all, Statistic::oadev, 120, 1.0).back(), 60U);
  EXPECT_EQ(factors(Kind::all, Statistic::ohdev, 120, 1.0).back(), 40U);
  EXPECT_EQ(factors(Kind::all, Statistic::mdev, 119, 1.0).back(), 40U);
  EXPECT_EQ(factors(Kind::all, Statistic::totdev, 120, 0.5).back(), 119U);
}

TEST(AveragingFactors, OfTheo1AreEvenAndTenAtLeast) {
  for (const Kind kind : {Kind::octave, Kind::decade, Kind::per_decade, Kind::all}) {
    const Factors m = factors(kind, Statistic::theo1, 1001);
    ASSERT_FALSE(m.empty());
    EXPECT_GE(m.front(), 10U);
    EXPECT_LE(m.back(), 1000U);
    for (const std::size_t factor : m) EXPECT_EQ(factor % 2, 0U);
    EXPECT_EQ(std::adjacent_find(m.begin(), m.end()), m.end());
  }
}

TEST(AveragingFactors, OfARecordTooShortAreNone) {
  for (int index = 0; index <= static_cast<int>(Statistic::pdev); ++index) {
    for (const Kind kind : {Kind::octave, Kind::decade, Kind::per_decade, Kind::all}) {
      EXPECT_TRUE(factors(kind, static_cast<Statistic>(index), 0).empty());
      EXPECT_TRUE(factors(kind, static_cast<Statistic>(index), 1).empty());
    }
  }
}

}  // namespace
}  // namespace proofmass::characterise::averaging_times_test
