#include "proofmass/estimate/fast/run_length_covariances.hpp"

#include <gtest/gtest.h>

namespace proofmass::estimate::covariance_runs_test {
namespace {

Symmetric<2> cov(double scale) {
  Symmetric<2> P;
  P(0, 0) = scale;
  P(1, 0) = 0.1 * scale;
  P(1, 1) = 3.0 * scale;
  return P;
}

TEST(RunLengthCovariances, KeepsOneForAsLongAsItStays) {
  RunLengthCovariances<2> runs;
  for (const double scale : {5.0, 2.0, 2.0, 2.0}) runs.push(cov(scale));
  runs.push(cov(1.0), 100);
  EXPECT_EQ(runs.size(), 104U);
  EXPECT_EQ(runs.kept(), 3U);
  EXPECT_EQ(runs.at(0), cov(5.0));
  EXPECT_EQ(runs.at(1), cov(2.0));
  EXPECT_EQ(runs.at(3), cov(2.0));
  EXPECT_EQ(runs.at(4), cov(1.0));
  EXPECT_EQ(runs.at(103), cov(1.0));
}

TEST(RunLengthCovariances, TurnsRoundWhatWasPushedFromTheEnd) {
  RunLengthCovariances<2> runs;
  runs.push(cov(1.0), 10);
  runs.push(cov(2.0), 3);
  runs.push(cov(5.0));
  runs.reverse();
  EXPECT_EQ(runs.size(), 14U);
  EXPECT_EQ(runs.at(0), cov(5.0));
  EXPECT_EQ(runs.at(1), cov(2.0));
  EXPECT_EQ(runs.at(3), cov(2.0));
  EXPECT_EQ(runs.at(4), cov(1.0));
  EXPECT_EQ(runs.at(13), cov(1.0));
}

TEST(RunLengthCovariances, NeverLeavesWhatItKeptByMoreThanItsTolerance) {
  RunLengthCovariances<2> runs;
  for (int k = 0; k < 1000; ++k) runs.push(cov(1.0 + 1e-12 * k));
  EXPECT_LT(runs.kept(), 120U);
  EXPECT_GT(runs.kept(), 80U);
  for (int k = 0; k < 1000; ++k)
    EXPECT_NEAR(runs.at(static_cast<std::size_t>(k))(0, 0), 1.0 + 1e-12 * k, 1.1e-11);
}

TEST(RunLengthCovariances, OfNothingIsEmpty) {
  RunLengthCovariances<2> runs;
  runs.push(cov(1.0), 0);
  runs.reverse();
  EXPECT_EQ(runs.size(), 0U);
  EXPECT_EQ(runs.kept(), 0U);
}

}  // namespace
}  // namespace proofmass::estimate::covariance_runs_test
