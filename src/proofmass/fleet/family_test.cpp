#include "proofmass/fleet/family.hpp"

#include <gtest/gtest.h>
#include <string>

#include "proofmass/core/random.hpp"

namespace proofmass::fleet::family_test {
namespace {

// Source: Y. Benjamini, Y. Hochberg (1995), table 1's p-values: at q = 0.05 the first four hold.
TEST(AdjustedP, NamesTheFourOfTheFifteenInThePaper) {
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  const std::vector<double> adjusted = adjusted_p(p);
  for (std::size_t k = 0; k < p.size(); ++k) EXPECT_EQ(adjusted[k] <= 0.05, k < 4) << k;
  EXPECT_NEAR(adjusted[0], 0.0001 * 15, 1e-12);
  EXPECT_NEAR(adjusted[3], 0.0095 * 15 / 4, 1e-12);
}

TEST(AdjustedP, DoesNotDependOnTheOrder) {
  EXPECT_EQ(adjusted_p({0.04, 0.001}), (std::vector<double>{0.04, 0.002}));
}

std::vector<SensorMean> family(Random& random, std::size_t size, double within_std = 0.0) {
  std::vector<SensorMean> means;
  for (std::size_t k = 0; k < size; ++k)
    means.push_back(
        {5.0 + 0.1 * random.normal() + within_std * random.normal(), within_std * within_std});
  return means;
}

TEST(FamilyTest, NamesThreeOfTwentySensorsThatAreFarOff) {
  Random random(3, "three of twenty");
  std::vector<SensorMean> means = family(random, 20);
  for (const std::size_t k : {2, 9, 16}) means[k].value += 2.0;
  FamilyTest test;
  const std::vector<Distance> found = test.distances(means);
  std::vector<double> p;
  for (const Distance& one : found) p.push_back(one.p);
  const std::vector<double> adjusted = adjusted_p(p);
  for (std::size_t k = 0; k < 20; ++k)
    EXPECT_EQ(adjusted[k] < 0.05, k == 2 || k == 9 || k == 16) << k;
}

// Without outliers the false discovery rate is the rate of any alarm: 500 fleets of 20 sensors and
// three figures, at 5 %: 25 with a standard deviation of 5.
TEST(FamilyTest, GivesFalseAlarmsAtTheStatedRate) {
  FamilyTest test;
  std::size_t alarms = 0;
  for (std::size_t fleet = 0; fleet < 500; ++fleet) {
    Random random(7, "false alarms", fleet);
    std::vector<double> p;
    for (int figure = 0; figure < 3; ++figure)
      for (const Distance& one : test.distances(family(random, 20, 0.03))) p.push_back(one.p);
    for (const double one : adjusted_p(p))
      if (one <= 0.05) {
        ++alarms;
        break;
      }
  }
  EXPECT_GE(alarms, 12U);
  EXPECT_LE(alarms, 38U);
}

TEST(FamilyTest, WeighsAMeanOfFewValuesByItsScatter) {
  Random random(5, "weights");
  std::vector<SensorMean> means = family(random, 12, 0.01);
  means[4] = {5.0 + 1.5, 1.0};  // measured once, with a standard deviation of 1
  FamilyTest test;
  EXPECT_GT(test.distances(means)[4].p, 0.05);
  means[4].within_variance = 1e-4;
  EXPECT_LT(test.distances(means)[4].p, 1e-3);
}

TEST(FamilyTest, IsSilentOnSmallFamiliesAndOnEqualValues) {
  FamilyTest test;
  EXPECT_TRUE(test.distances({{1.0, 0.0}, {2.0, 0.0}, {9.0, 0.0}}).empty());
  EXPECT_TRUE(test.distances(std::vector<SensorMean>(10, {1.0, 0.0})).empty());
}

}  // namespace
}  // namespace proofmass::fleet::family_test
