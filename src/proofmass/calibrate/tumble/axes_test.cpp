#include "proofmass/calibrate/tumble/axes.hpp"

#include <gtest/gtest.h>

#include "proofmass/calibrate/tumble/dwells.hpp"
#include "proofmass/calibrate/tumble/scatter.hpp"
#include "proofmass/calibrate/tumble_test_support.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate::tumble_axes_test {
namespace {

constexpr double quarter = 0.5 * std::numbers::pi;

// Outputs of axes at the given phases, with misalignment and bias.
std::vector<double> follow(const std::vector<TumblePosition>& plan,
                           double phase,
                           double size = 1.0) {
  std::vector<double> out;
  for (const TumblePosition& p : plan)
    out.push_back(0.1 + size * std::sin(p.angle_rad + p.mount_rad + phase + 0.02));
  return out;
}

TEST(TumbleAxes, FindsThePhaseOfEveryAxis) {
  const auto plan = table_turn(8);
  const std::vector<std::vector<double>> outputs{follow(plan, 0.0), follow(plan, quarter),
                                                 follow(plan, 0.0, 0.01), follow(plan, -quarter)};
  const auto axes = tumble_axes(plan, outputs);
  EXPECT_EQ(axes[0].phase_rad[0], 0.0);
  EXPECT_EQ(axes[1].phase_rad[0], quarter);
  EXPECT_FALSE(axes[2].follows_angle());
  EXPECT_EQ(axes[3].phase_rad[0], 3.0 * quarter);
  EXPECT_NE(axes[1].words.find("follows cos(angle): 90° were added"), std::string::npos);
  EXPECT_NE(axes[2].words.find("is parallel to the table's"), std::string::npos);
}

TEST(TumbleAxes, LetsTheUserOverrule) {
  const auto plan = table_turn(8);
  const std::vector<std::vector<double>> outputs{follow(plan, 2.0 * quarter)};
  EXPECT_EQ(tumble_axes(plan, outputs)[0].phase_rad[0], 2.0 * quarter);
  EXPECT_EQ(tumble_axes(plan, outputs, 0)[0].phase_rad[0], 0.0);
}

TEST(TumbleAxes, ReportsTheDeviationOfAnAxis) {
  const auto plan = table_turn(8);
  const std::vector<std::vector<double>> outputs{follow(plan, 0.4)};
  EXPECT_NE(tumble_axes(plan, outputs)[0].words.find("deviation of 24°"), std::string::npos);
}

TEST(TumbleAxes, FindsTheInputAxisInASecondPlaneOfTwoPositions) {
  std::vector<TumblePosition> plan = table_turn(4);
  append(plan, in_plane(table_turn(2), 2));
  // x: sin in plane 1, 0 in plane 2; y: cos in plane 1, parallel to the table in plane 2; z the
  // reverse.
  const std::vector<std::vector<double>> outputs{
      {0, 1, 0, -1, 0, 0}, {1, 0, -1, 0, 0, 0}, {0, 0, 0, 0, 1, -1}};
  const auto axes = tumble_axes(plan, outputs);
  EXPECT_EQ(axes[0].phase_rad[1], 0.0);
  EXPECT_FALSE(axes[1].phase_rad[1]);
  EXPECT_FALSE(axes[2].phase_rad[0]);
  EXPECT_EQ(axes[2].phase_rad[1], quarter);
}

TEST(SteadyAngles, AreFoundBetweenTheMoves) {
  std::vector<double> angle, output;
  for (int rest = 0; rest < 4; ++rest) {
    for (int k = 0; k < 300; ++k) {
      angle.push_back(rest * quarter + 1e-5 * std::sin(0.7 * k));
      output.push_back(rest + 1e-3 * std::sin(1.3 * k * k));
    }
    for (int k = 1; k < 100; ++k) {
      angle.push_back(rest * quarter + quarter * k / 100.0);
      output.push_back(rest + 5.0);
    }
  }
  const auto dwells = steady_angles(angle, {.rate_hz = 100.0});
  ASSERT_EQ(dwells.size(), 4U);
  const auto angles = dwell_angles(angle, dwells);
  const auto outputs = dwell_outputs(output, dwells).value();
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(angles[k], static_cast<double>(k) * quarter, 1e-5);
    EXPECT_NEAR(outputs.mean[k], static_cast<double>(k), 3e-4);
    EXPECT_GT(outputs.std[k], 0.0);
  }
}

TEST(SteadyAngles, AreCutToWhereTheSensorLayStill) {
  const std::vector<Dwell> steady{
      {.first = 0, .last = 99}, {.first = 100, .last = 199}, {.first = 200, .last = 299}};
  const std::vector<signal::Rest> rests{{0, 90}, {130, 150}, {155, 195}, {297, 320}};
  const std::vector<Dwell> found = at_rest(steady, rests);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].last, 90U);
  EXPECT_EQ(found[1].first, 155U);
  EXPECT_EQ(found[1].last, 195U);
}

TEST(SteadyAngles, AreNotATableThatTurnsSlowly) {
  std::vector<double> angle;
  for (int k = 0; k < 20000; ++k) angle.push_back(0.3 * rad_per_deg * k / 100.0);
  EXPECT_TRUE(steady_angles(angle, {.rate_hz = 100.0}).empty());
  EXPECT_TRUE(steady_angles({}, {.rate_hz = 100.0}).empty());
}

TEST(RestrictedScatter, IsTheMaximumOfTheDenseLikelihood) {
  const auto plan = there_and_back(6);
  const auto n = static_cast<Eigen::Index>(plan.size());
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd A(n, 4);
  std::vector<Eigen::VectorXd> common(6, Eigen::VectorXd::Zero(n));
  Eigen::VectorXd y(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double angle = plan[static_cast<std::size_t>(k)].angle_rad;
    A.row(k) << 1.0, std::sin(angle), std::cos(angle), 2.0 * std::cos(angle) * std::cos(angle);
    const auto setting = static_cast<std::size_t>(std::lround(angle * 3.0 / std::numbers::pi)) % 6;
    common[setting](k) = 0.8 * std::cos(angle);
    y(k) = normal(random);
  }
  for (const Eigen::VectorXd& w : common) y += w * normal(random);
  const auto likelihood = [&](double sigma) {
    Eigen::MatrixXd V = sigma * sigma * Eigen::MatrixXd::Identity(n, n);
    for (const Eigen::VectorXd& w : common) V += w * w.transpose();
    const PositiveInverse inverse = invert_positive(V);
    const PositiveInverse of_A = invert_positive(A.transpose() * inverse.inverse * A);
    const Eigen::VectorXd Vy = inverse.inverse * y;
    const Eigen::VectorXd b = A.transpose() * Vy;
    return -0.5 *
           (inverse.log_determinant + of_A.log_determinant + y.dot(Vy) - b.dot(of_A.inverse * b));
  };
  const TumbleScatter found = restricted_scatter(A, y, common);
  EXPECT_GT(likelihood(found.sigma), likelihood(found.sigma * 1.001));
  EXPECT_GT(likelihood(found.sigma), likelihood(found.sigma * 0.999));
  EXPECT_GE(found.dof, 1.0);
  EXPECT_LE(found.dof, static_cast<double>(n - 4));
}

}  // namespace
}  // namespace proofmass::calibrate::tumble_axes_test
