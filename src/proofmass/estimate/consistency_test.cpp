#include "proofmass/estimate/consistency.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/consistency_verdict.hpp"
#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/smoother_consistency.hpp"

namespace proofmass::estimate::consistency_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A random-walk level in white noise, with a filter that may assume other noise parameters.
struct LocalLevel {
  double walk_std = 0.1, noise_std = 1.0;  ///< true, per step
  double believed_walk_std = 0.1, believed_noise_std = 1.0;
  double gate = std::numeric_limits<double>::infinity();
  std::size_t steps = 20000;
  std::uint64_t seed = 1;
  double outlier_share = 0.0;
  double drift = 0.0;  ///< ramp per step in the measurements
};

Consistency run(const LocalLevel& o) {
  ConsistencyCheck check({.channels = {"z"}, .rate_hz = 1.0, .gate = o.gate});
  Random random(o.seed, "local level");
  double level = 0.0, x = 0.0;
  const double Q = std::pow(o.believed_walk_std, 2), R = std::pow(o.believed_noise_std, 2);
  double P = 0.5 * (Q + std::sqrt(Q * Q + 4.0 * Q * R)) - Q;  // steady-state value
  for (std::size_t k = 0; k < o.steps; ++k) {
    level += o.walk_std * random.normal();
    const bool outlier = random.unit() < o.outlier_share;
    const double z = level + o.noise_std * random.normal() + (outlier ? 15.0 : 0.0);
    P += Q;
    const double S = P + R, y = z - x;
    const bool used = std::abs(y) <= o.gate * std::sqrt(S);
    check.add(0, y, S, used);
    if (!used) continue;
    x += P / S * y;
    P *= R / S;
  }
  return check.judge();
}

Consistency white(double std, std::size_t count, std::uint64_t seed = 1, double gate = INFINITY) {
  ConsistencyCheck check({.channels = {"z"}, .gate = gate});
  Random random(seed, "white");
  for (std::size_t k = 0; k < count; ++k) {
    const double nu = std * random.normal();
    check.add(0, nu, 1.0, std::abs(nu) <= gate);
  }
  return check.judge();
}

TEST(Consistency, BoundsOfAThousandInnovationsAreThePublishedOnes) {
  const Consistency result = white(1.0, 1000);
  EXPECT_EQ(result.innovations, 1000U);
  EXPECT_NEAR(result.nis_lower, 0.914, 5e-4);
  EXPECT_NEAR(result.nis_upper, 1.090, 5e-4);
  EXPECT_EQ(result.verdict, Verdict::consistent);
  EXPECT_EQ(result.remedy, Remedy::none);
}

TEST(Consistency, CountsOnlyAcceptedChannelsThatWereThere) {
  ConsistencyCheck check({.channels = {"x", "y"}});
  check.add(0, 2.0, 4.0);
  check.add(1, 30.0, 1.0, false);
  check.add(0, nan, 1.0);
  check.add(1, 1.0, nan);
  check.add(1, 1.0, 0.0);
  check.miss(1);
  check.add(1, 3.0, 1.0);
  const Consistency result = check.judge();
  EXPECT_EQ(result.innovations, 2U);
  EXPECT_EQ(result.gated, 1U);
  EXPECT_DOUBLE_EQ(result.nis, 5.0);
  EXPECT_DOUBLE_EQ(result.channels[0].nis, 1.0);
  EXPECT_DOUBLE_EQ(result.channels[1].nis, 9.0);
  EXPECT_DOUBLE_EQ(*result.all.inside_95, 1.0 / 3.0);
  EXPECT_EQ(result.verdict, Verdict::undetermined);
}

TEST(Consistency, WithoutInnovationsIsUndetermined) {
  const Consistency result = ConsistencyCheck({.channels = {"x"}}).judge();
  EXPECT_EQ(result.innovations, 0U);
  EXPECT_EQ(result.verdict, Verdict::undetermined);
  EXPECT_FALSE(result.nis_ungated);
  EXPECT_FALSE(result.all.lag_one);
}

TEST(Consistency, TakesSumsOverChannelsWithoutTheirSigns) {
  ConsistencyCheck check({});
  Random random(3, "nis");
  for (int k = 0; k < 3000; ++k) {
    double nis = 0.0;
    for (int i = 0; i < 3; ++i) nis += std::pow(1.5 * random.normal(), 2);
    check.add_nis(nis, 3);
  }
  const Consistency result = check.judge();
  EXPECT_EQ(result.innovations, 9000U);
  EXPECT_EQ(result.verdict, Verdict::overconfident);
  EXPECT_EQ(result.remedy, Remedy::both_noises);
  EXPECT_NEAR(result.remedy_factor, 1.5, 0.03);
  EXPECT_FALSE(result.all.inside_95);
}

TEST(Consistency, LagOneIsTheProductOfNeighboursAcrossNoGap) {
  ConsistencyCheck check({.channels = {"z"}});
  for (const double nu : {1.0, 2.0, nan, 3.0, -1.0}) check.add(0, nu, 1.0);
  // Neighbours: 1·2 and 3·(−1); ⟨ν²⟩ = 15/4.
  EXPECT_NEAR(*check.judge().all.lag_one, -0.5 / 3.75, 1e-15);
}

TEST(Consistency, StretchesAddUpNeighbours) {
  ConsistencyCheck check({.channels = {"z"}, .rate_hz = 10.0});
  for (int k = 0; k < 64; ++k) check.add(0, k % 4 < 2 ? 1.0 : -1.0, 1.0);
  const auto result = check.judge();
  ASSERT_EQ(result.all.stretches.size(), 2U);
  EXPECT_DOUBLE_EQ(result.all.stretches[0].length_s, 0.2);
  EXPECT_EQ(result.all.stretches[0].stretches, 32U);
  EXPECT_DOUBLE_EQ(result.all.stretches[0].factor, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(result.all.stretches[1].factor, 0.0);
}

TEST(Consistency, UndoesWhatAGateHasCutOff) {
  // The variance of N(0, 1) truncated to ± 2 is 0.7737.
  EXPECT_NEAR(*ungated_std(0.773741, 2.0), 1.0, 1e-5);
  EXPECT_FALSE(ungated_std(1.33, 2.0));  // uniform over the gate: 4/3
  EXPECT_EQ(*ungated_std(0.0, 2.0), 0.0);
  const Consistency result = white(1.0, 100000, 5, 2.0);
  EXPECT_NEAR(result.nis, 0.7737, 0.01);
  EXPECT_NEAR(*result.nis_ungated, 1.0, 0.03);
  EXPECT_EQ(result.verdict, Verdict::consistent);
  EXPECT_NEAR(*white(1.5, 100000, 5, 3.0).all.std_factor, 1.5, 0.03);
}

TEST(Consistency, IdentifiesTheWrongNoise) {
  struct Case {
    const char* what;
    double walk, noise;  ///< assumed; the truth is 0.1 and 1
    Verdict verdict;
    Remedy remedy;
    double factor, tolerance;
  };
  for (const Case& c : {
           Case{"true", 0.1, 1.0, Verdict::consistent, Remedy::none, 1.0, 0.0},
           Case{"both small", 0.05, 0.5, Verdict::overconfident, Remedy::both_noises, 2.0, 0.05},
           Case{"both large", 0.2, 2.0, Verdict::cautious, Remedy::both_noises, 0.5, 0.02},
           Case{"walk small", 0.03, 1.0, Verdict::coloured, Remedy::process_noise, 3.3, 0.7},
           Case{"walk large", 0.4, 1.0, Verdict::coloured, Remedy::process_noise, 0.25, 0.1},
           Case{"noise small", 0.1, 0.4, Verdict::overconfident, Remedy::measurement_noise, 2.5,
                0.4},
           Case{"noise large", 0.1, 2.0, Verdict::coloured, Remedy::measurement_noise, 0.5, 0.1},
       }) {
    const Consistency result = run({.believed_walk_std = c.walk, .believed_noise_std = c.noise});
    EXPECT_EQ(result.verdict, c.verdict) << c.what;
    EXPECT_EQ(result.remedy, c.remedy) << c.what;
    EXPECT_NEAR(result.remedy_factor, c.factor, c.tolerance) << c.what;
  }
}

TEST(Consistency, ASignificantButNegligibleDeviationIsConsistent) {
  const Consistency result = white(1.02, 1000000);
  EXPECT_GT(result.nis, result.nis_upper);
  EXPECT_EQ(result.verdict, Verdict::consistent);
}

TEST(Consistency, ALargeButInsignificantDeviationIsConsistent) {
  EXPECT_EQ(white(1.15, 40, 8).verdict, Verdict::consistent);
}

TEST(Consistency, AFewWildReadingsAskForAGateNotForMoreNoise) {
  const Consistency result = run({.outlier_share = 0.01});
  EXPECT_EQ(result.verdict, Verdict::overconfident);
  EXPECT_EQ(result.remedy, Remedy::outliers);
  EXPECT_EQ(run({.gate = 5.0, .outlier_share = 0.01}).verdict, Verdict::consistent);
}

TEST(Consistency, AFilterThatLeavesOutMuchIsNotConsistent) {
  ConsistencyCheck check({.channels = {"z"}, .gate = 5.0});
  Random random(2, "left out");
  for (int k = 0; k < 1000; ++k) check.add(0, random.normal(), 1.0, k % 10 != 0);
  EXPECT_EQ(check.judge().verdict, Verdict::overconfident);
  EXPECT_EQ(check.judge().remedy, Remedy::outliers);
}

TEST(Consistency, ASlowErrorUnderTheNoiseIsSeenInLongStretches) {
  ConsistencyCheck check({.channels = {"z"}, .rate_hz = 100.0});
  Random random(4, "slow");
  for (int k = 0; k < 60000; ++k)
    check.add(0, random.normal() + 0.15 * std::sin(2e-4 * k * 6.28), 1.0);
  const Consistency result = check.judge();
  EXPECT_LT(std::abs(*result.all.lag_one), 0.05);
  EXPECT_EQ(result.verdict, Verdict::coloured);
  EXPECT_EQ(result.remedy, Remedy::slow_noise);
  EXPECT_GT(result.remedy_factor, 3.0);
}

TEST(Consistency, NamesTheChannelThatIsOff) {
  ConsistencyCheck check({.channels = {"x", "y", "z"}});
  Random random(6, "channels");
  for (int k = 0; k < 5000; ++k)
    for (std::size_t i = 0; i < 3; ++i) check.add(i, (i == 1 ? 2.0 : 1.0) * random.normal(), 1.0);
  const Consistency result = check.judge();
  ASSERT_TRUE(result.worst_channel);
  EXPECT_EQ(result.channels[*result.worst_channel].name, "y");
  EXPECT_NEAR(result.remedy_factor, 2.0, 0.1);
}

TEST(Consistency, AnErrorCommonToAllChannelsIsNotAttributedToOne) {
  ConsistencyCheck check({.channels = {"x", "y"}});
  Random random(6, "channels");
  for (int k = 0; k < 5000; ++k)
    for (std::size_t i = 0; i < 2; ++i) check.add(i, 2.0 * random.normal(), 1.0);
  EXPECT_FALSE(check.judge().worst_channel);
  EXPECT_EQ(check.judge().verdict, Verdict::overconfident);
}

TEST(Consistency, OfATrueFilterIsRarelyDoubted) {
  std::size_t doubted = 0, outside = 0;
  constexpr std::size_t runs = 400;
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    const Consistency result = run({.steps = 500, .seed = seed});
    doubted += result.verdict != Verdict::consistent ? 1 : 0;
    outside += result.nis < result.nis_lower || result.nis > result.nis_upper ? 1 : 0;
  }
  EXPECT_LE(doubted, 0.06 * runs);
  EXPECT_NEAR(static_cast<double>(outside), 0.05 * runs, 0.022 * runs);
}

TEST(Consistency, SaysTheSameOfSeriesAndTestsTheirWhiteness) {
  Random random(9, "series");
  std::vector<double> y, S;
  std::vector<unsigned char> used;
  ConsistencyCheck check({.channels = {"z"}, .rate_hz = 10.0});
  for (int k = 0; k < 3000; ++k) {
    y.push_back(k % 50 == 0 ? nan : 2.0 * random.normal());
    S.push_back(4.0);
    used.push_back(k % 77 != 0 ? 1 : 0);
    check.add(0, y.back(), S.back(), used.back() != 0);
  }
  const Consistency result =
      check_consistency({{y, S, used}}, {.channels = {"z"}, .rate_hz = 10.0});
  EXPECT_EQ(result.nis, check.judge().nis);
  EXPECT_EQ(result.gated, check.judge().gated);
  ASSERT_EQ(result.whiteness.size(), 1U);
  ASSERT_FALSE(result.whiteness[0].empty());
  EXPECT_TRUE(result.whiteness[0].front().white);
}

TEST(Consistency, AllocatesNothingWhileItRuns) {
  ConsistencyCheck check({.channels = {"x", "y"}});
  AuxiliaryTally tally;
  const std::size_t before = test::allocations();
  for (int k = 0; k < 1000; ++k) {
    check.add(0, 1.0, 2.0);
    check.add(1, -1.0, 2.0);
    check.add_nis(1.0, 2);
    tally.add(1.0, 2.0);
  }
  EXPECT_EQ(test::allocations(), before);
}

TEST(Consistency, StaysFiniteWithInnovationsBeyondAllMeasure) {
  ConsistencyCheck check({.channels = {"z"}});
  for (int k = 0; k < 100; ++k) check.add(0, k % 2 == 0 ? 1e300 : -1e300, 1e-300);
  const Consistency result = check.judge();
  EXPECT_TRUE(std::isfinite(result.nis));
  EXPECT_EQ(result.verdict, Verdict::overconfident);
  EXPECT_TRUE(std::isfinite(result.remedy_factor));
}

}  // namespace
}  // namespace proofmass::estimate::consistency_test
