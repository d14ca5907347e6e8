#include "proofmass/estimate/filter/nees.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/smoother_consistency.hpp"

namespace proofmass::estimate::nees_test {
namespace {

TEST(Nees, BoundsOfFiftyRunsOfFourStatesAreThePublishedOnes) {
  const Bounds bounds = mean_nees_95(50, 4);
  EXPECT_NEAR(bounds.lower, 3.25, 5e-3);
  EXPECT_NEAR(bounds.upper, 4.82, 5e-3);
}

TEST(Nees, IsTheErrorInUnitsOfItsCovariance) {
  Eigen::MatrixXd cov(2, 2);
  cov << 4.0, 1.0, 1.0, 2.0;
  // (2, 1) P⁻¹ (2, 1)ᵀ with P⁻¹ = [2 −1; −1 4]/7.
  EXPECT_NEAR(normalised_error_squared(Eigen::Vector2d(2.0, 1.0), cov), 8.0 / 7.0, 1e-12);
}

TEST(Nees, IsWithinItsBoundsForATrueCovarianceAndOutsideForASmallOne) {
  Random random(1, "nees");
  NeesTally honest, boastful;
  const Eigen::MatrixXd cov = Eigen::Vector3d(1.0, 4.0, 0.25).asDiagonal();
  for (int run = 0; run < 300; ++run) {
    const Eigen::Vector3d error(random.normal(), 2.0 * random.normal(), 0.5 * random.normal());
    honest.add(error, cov);
    boastful.add(error, 0.7 * cov);
  }
  EXPECT_TRUE(honest.inside());
  EXPECT_FALSE(boastful.inside());
  EXPECT_NEAR(honest.coverage(), 0.95, 0.02);
  EXPECT_NEAR(boastful.mean(), honest.mean() / 0.7, 1e-9);
}

TEST(Nees, ShareInsideABandIsBoundedByTheBinomialDistribution) {
  const Bounds thousand = share_inside_95(1000, 0.95);  // scipy.stats.binom.ppf: 936 and 963
  EXPECT_DOUBLE_EQ(thousand.lower, 0.936);
  EXPECT_DOUBLE_EQ(thousand.upper, 0.963);
  const Bounds ten = share_inside_95(10, 0.5);  // 2 and 8
  EXPECT_DOUBLE_EQ(ten.lower, 0.2);
  EXPECT_DOUBLE_EQ(ten.upper, 0.8);
  EXPECT_EQ(share_inside_95(3, 0.99).upper, 1.0);
}

TEST(AuxiliaryTally, StatesTheUncertaintyOfAMeanSquareOfCorrelatedResiduals) {
  int covered = 0;
  constexpr int runs = 200;
  for (int run = 0; run < runs; ++run) {
    Random random(7, "auxiliary", static_cast<std::size_t>(run));
    AuxiliaryTally tally;
    double x = random.normal();
    for (int k = 0; k < 4096; ++k) {
      tally.add(3.0 * x, 9.0);
      x = 0.9 * x + std::sqrt(1.0 - 0.81) * random.normal();
    }
    const Uncertain found = *tally.mean_square();
    covered += std::abs(found.value - 1.0) <= 2.0 * found.std ? 1 : 0;
  }
  EXPECT_GE(covered, 0.88 * runs);
}

TEST(AuxiliaryTally, CountsOnlyInformativeResiduals) {
  AuxiliaryTally tally;
  tally.add(1.0, 0.0);
  tally.add(NAN, 1.0);
  EXPECT_EQ(tally.count(), 0U);
  EXPECT_FALSE(tally.mean_square());
  for (int k = 0; k < 64; ++k) tally.add(k == 7 ? -12.0 : 2.0, 4.0);
  EXPECT_EQ(tally.furthest(), 6.0);
  EXPECT_DOUBLE_EQ(tally.mean_square()->value, (63.0 + 36.0) / 64.0);
}

}  // namespace
}  // namespace proofmass::estimate::nees_test
