#include "proofmass/calibrate/uncertainty_budget.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "proofmass/core/chi_square.hpp"

namespace proofmass::calibrate::uncertainty_budget_test {
namespace {

using D = Distribution;

// GUM, H.1: a gauge block of nominally 50 mm compared with a standard; lengths in nm.
std::vector<BudgetLine> end_gauge() {
  return {
      {"standard", false, D::normal, 25.0, "nm", 1.0, 18.0},
      {"comparison", true, D::student_t, 5.8, "nm", 1.0, 24.0},
      {"comparator, random", false, D::normal, 3.9, "nm", 1.0, 5.0},
      {"comparator, systematic", false, D::normal, 6.7, "nm", 1.0, 8.0},
      {"difference of expansion", false, D::uniform, 0.58e-6, "1/K", 50.000623e6 * 0.1, 50.0},
      {"difference of temperature", false, D::uniform, 0.029, "K", -50.000623e6 * 11.5e-6, 2.0}};
}

TEST(Combine, GivesTheEndGaugeOfTheGuide) {
  const auto budget = combine({"length", "nm", 50000838.0}, end_gauge()).value();
  EXPECT_NEAR(budget.combined_std, 32.0, 0.5);
  EXPECT_NEAR(budget.lines[4].contribution(), 2.9, 0.05);
  EXPECT_NEAR(budget.lines[5].contribution(), -16.6, 0.1);
  EXPECT_EQ(std::floor(budget.effective_dof), 16.0);
  const double k99 = coverage_factor(0.99, budget.effective_dof);
  EXPECT_NEAR(k99, 2.92, 0.005);
  // The guide rounds to 32 nm first: 93 nm; without rounding 92.5 nm.
  EXPECT_NEAR(k99 * budget.combined_std, 93.0, 1.0);
  EXPECT_NEAR(budget.expanded_95, coverage_factor(0.95, 16.0) * budget.combined_std, 1e-12);
}

// GUM, H.2: resistance R = V/I cos φ from five sets of simultaneous observations.
TEST(Combine, GivesTheCorrelatedResistanceOfTheGuide) {
  Eigen::Matrix<double, 5, 3> observed;
  observed << 5.007, 19.663e-3, 1.0456, 4.994, 19.639e-3, 1.0438, 5.005, 19.640e-3, 1.0468, 4.990,
      19.685e-3, 1.0428, 4.999, 19.678e-3, 1.0433;
  const Eigen::RowVector3d mean = observed.colwise().mean();
  const Eigen::Matrix<double, 5, 3> apart = observed.rowwise() - mean;
  const Eigen::Matrix3d covariance = apart.transpose() * apart / (5.0 * 4.0);
  const Eigen::Vector3d u = covariance.diagonal().cwiseSqrt();
  const Eigen::Matrix3d r =
      u.cwiseInverse().asDiagonal() * covariance * u.cwiseInverse().asDiagonal();
  const double R = mean(0) / mean(1) * std::cos(mean(2));
  const std::vector<BudgetLine> lines{
      {"V", true, D::student_t, u(0), "V", R / mean(0), 4.0},
      {"I", true, D::student_t, u(1), "A", -R / mean(1), 4.0},
      {"phi", true, D::student_t, u(2), "rad", -R * std::tan(mean(2)), 4.0}};
  const auto budget = combine({"R", "ohm", R}, lines, r).value();
  EXPECT_NEAR(R, 127.732, 0.0005);
  EXPECT_NEAR(budget.combined_std, 0.071, 0.0005);
  // Five simultaneous observations: the dof of a mean of five.
  EXPECT_NEAR(budget.effective_dof, 4.0, 1e-9);
  EXPECT_NEAR(std::accumulate(budget.shares.begin(), budget.shares.end(), 0.0), 1.0, 1e-12);
}

TEST(Combine, OfCertainLinesHasInfinitelyManyDegreesOfFreedom) {
  const std::vector<BudgetLine> lines{{"a", false, D::normal, 3.0, "V", 1.0, 0.0},
                                      {"b", false, D::normal, 2.0, "V", -2.0, 0.0}};
  const auto budget = combine({"y", "V", 1.0}, lines).value();
  EXPECT_DOUBLE_EQ(budget.combined_std, 5.0);
  EXPECT_EQ(budget.effective_dof, 0.0);
  EXPECT_NEAR(budget.coverage_factor_95, 1.959964, 1e-6);
  EXPECT_NEAR(budget.shares[0], 0.36, 1e-15);
  EXPECT_NEAR(budget.shares[1], 0.64, 1e-15);
}

TEST(Combine, OfFullyCorrelatedLinesAddsThemAndOfOppositeOnesTakesThemAway) {
  const std::vector<BudgetLine> lines{{"a", false, D::normal, 3.0, "V", 1.0, 0.0},
                                      {"b", false, D::normal, 3.0, "V", 1.0, 0.0}};
  Eigen::MatrixXd r = Eigen::MatrixXd::Ones(2, 2);
  EXPECT_DOUBLE_EQ(combine({"y", "V", 1.0}, lines, r).value().combined_std, 6.0);
  r(0, 1) = r(1, 0) = -1.0;
  const auto opposite = combine({"y", "V", 1.0}, lines, r).value();
  EXPECT_EQ(opposite.combined_std, 0.0);
  EXPECT_EQ(opposite.expanded_95, 0.0);
}

TEST(Combine, OfNothingIsZero) {
  const auto budget = combine({"y", "V", 1.0}, {}).value();
  EXPECT_EQ(budget.combined_std, 0.0);
  EXPECT_TRUE(budget.shares.empty());
}

TEST(Combine, SaysWhyItCannot) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BudgetLine> one{{"a", false, D::normal, 1.0, "V", 1.0, 0.0}};
  const std::vector<BudgetLine> two{one[0], one[0]};
  EXPECT_EQ(combine({"y", "V", nan}, one).error().code, Errc::not_finite);
  EXPECT_EQ(combine({"y", "V", 0.0}, {{"a", false, D::normal, nan, "V"}}).error().code,
            Errc::not_finite);
  const auto negative = combine({"y", "V", 0.0}, {{"a", false, D::normal, -1.0, "V"}});
  EXPECT_EQ(negative.error().code, Errc::invalid_argument);
  EXPECT_NE(negative.error().message.find("y: a: "), std::string::npos);
  Eigen::MatrixXd r = Eigen::MatrixXd::Identity(2, 2);
  EXPECT_EQ(combine({"y", "V", 0.0}, one, r).error().code, Errc::invalid_argument);
  r(0, 1) = 0.5;
  EXPECT_FALSE(combine({"y", "V", 0.0}, two, r));
  r(1, 0) = 0.5;
  EXPECT_TRUE(combine({"y", "V", 0.0}, two, r));
  r(0, 1) = r(1, 0) = 1.5;
  EXPECT_FALSE(combine({"y", "V", 0.0}, two, r));
}

TEST(CoverageFactor, IsTheTableOfTheGuide) {  // GUM, table G.2
  EXPECT_NEAR(coverage_factor(0.95, 1.0), 12.71, 0.005);
  EXPECT_NEAR(coverage_factor(0.95, 4.0), 2.78, 0.005);
  EXPECT_NEAR(coverage_factor(0.95, 4.9), 2.78, 0.005);
  EXPECT_NEAR(coverage_factor(0.9545, 10.0), 2.28, 0.005);
  EXPECT_NEAR(coverage_factor(0.99, 50.0), 2.68, 0.005);
  EXPECT_NEAR(coverage_factor(0.9973, 0.0), 3.0, 0.005);
  EXPECT_NEAR(coverage_factor(0.95, 0.5), student_t_quantile(0.975, 0.5), 1e-9);
}

TEST(StdOfHalfWidth, IsThatOfEachShape) {  // GUM, 4.3.7, 4.3.9, 4.4.5
  EXPECT_NEAR(std_of_half_width(3.0, D::uniform), std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(std_of_half_width(6.0, D::triangular), std::sqrt(6.0), 1e-15);
  EXPECT_NEAR(std_of_half_width(2.0, D::arcsine), std::sqrt(2.0), 1e-15);
  EXPECT_EQ(std_of_half_width(2.0, D::normal), 2.0);
  EXPECT_EQ(std_of_half_width(2.0, D::student_t), 2.0);
}

}  // namespace
}  // namespace proofmass::calibrate::uncertainty_budget_test
