#include "proofmass/calibrate/multi_position.hpp"

#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position_test_support.hpp"
#include "proofmass/calibrate/validation.hpp"

namespace proofmass::calibrate::multi_position_test {
namespace {

using test::drawn_poses;
using test::drawn_sensor;
using test::g;
using test::mg;
using test::reading;

MultiPositionOptions with_noise(double dof) {
  return {.gravity_mps2 = g, .noise_dof = dof};
}

std::vector<Pose> poses_along(const Parameters& truth, const std::vector<Eigen::Vector3d>& up) {
  std::vector<Pose> poses;
  for (const Eigen::Vector3d& direction : up) {
    Pose& pose = poses.emplace_back();
    pose.mean = reading(truth, g * direction.normalized());
    pose.up = direction.normalized();
  }
  return poses;
}

std::vector<Eigen::Vector3d> six_sides() {
  std::vector<Eigen::Vector3d> up;
  for (int k = 0; k < 3; ++k) {
    up.push_back(Eigen::Vector3d::Unit(k));
    up.push_back(-Eigen::Vector3d::Unit(k));
  }
  return up;
}

TEST(MultiPosition, IsExactWithoutNoise) {
  std::mt19937_64 random(1);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {.noise_mps2 = 0.0, .claimed_mps2 = 0.0}, random);
  const MultiPosition fit = calibrate_positions(poses, with_noise(0.0)).value();
  for (std::size_t k = 0; k < 9; ++k) {
    const double size = k < 3 ? 33000.0 : k < 6 ? 414.0 : 1.0;
    EXPECT_NEAR(fit.estimate[k], truth(static_cast<Eigen::Index>(k)), 1e-11 * size) << k;
  }
  EXPECT_TRUE(fit.converged);
  EXPECT_LT(fit.residual_rms_mps2, 1e-10);
  for (const PoseResidual& pose : fit.poses) EXPECT_FALSE(pose.suspect);
}

TEST(MultiPosition, DoesNotDependOnTheUnitOfTheReading) {
  std::mt19937_64 random(2);
  const Parameters truth = drawn_sensor(random);
  std::vector<Pose> counts = drawn_poses(truth, {}, random), volts = counts;
  constexpr double volts_per_count = 1e-4, offset = -2.5;
  for (Pose& pose : volts) {
    pose.mean = volts_per_count * pose.mean.array() + offset;
    pose.mean_covariance *= volts_per_count * volts_per_count;
  }
  const MultiPosition a = calibrate_positions(counts, with_noise(500.0)).value();
  const MultiPosition b = calibrate_positions(volts, with_noise(500.0)).value();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(b.bias[k]->value, volts_per_count * a.bias[k]->value + offset, 1e-9);
    EXPECT_NEAR(b.scale[k]->std, volts_per_count * a.scale[k]->std, 1e-7 * b.scale[k]->std);
    EXPECT_NEAR(b.misalignment_rad[k]->value, a.misalignment_rad[k]->value, 1e-9);
  }
}

TEST(MultiPosition, LeavesOneOutAsAFitWithoutItDoes) {
  std::mt19937_64 random(3);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {.count = 14}, random);
  const MultiPosition fit = calibrate_positions(poses, with_noise(500.0)).value();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    std::vector<Pose> others = poses;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const MultiPosition without = calibrate_positions(others, with_noise(500.0)).value();
    const Validation against = validate(without, View<Pose>(&poses[k], 1));
    EXPECT_NEAR(*fit.poses[k].leave_one_out_mps2, against.residuals_mps2.front(), 2e-3 * mg) << k;
  }
}

TEST(MultiPosition, NamesThePoseThatWasPushed) {
  std::mt19937_64 random(4);
  const Parameters truth = drawn_sensor(random);
  auto poses = drawn_poses(truth, {}, random);
  const Eigen::Vector3d force = test::drawn_direction(random);
  poses[7].mean = reading(truth, (g + 5.0 * mg) * force);
  const MultiPosition fit = calibrate_positions(poses, with_noise(500.0)).value();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(fit.poses[k].suspect, k == 7) << k;
    EXPECT_EQ(fit.poses[k].used, k != 7) << k;
  }
  EXPECT_NEAR(*fit.poses[7].leave_one_out_mps2, 5.0 * mg, 0.5 * mg);
  EXPECT_GT(fit.lack_of_fit->p, 0.01);
  MultiPositionOptions keep = with_noise(500.0);
  keep.keep_suspects = true;
  const MultiPosition kept = calibrate_positions(poses, keep).value();
  EXPECT_TRUE(kept.poses[7].suspect);
  EXPECT_TRUE(kept.poses[7].used);
  EXPECT_LT(kept.lack_of_fit->p, 1e-6);
}

TEST(MultiPosition, ReportsAnUnidentifiedBadPosition) {
  std::mt19937_64 random(5);
  const Parameters truth = drawn_sensor(random);
  auto poses = drawn_poses(truth, {.count = 11}, random);
  poses[4].mean = reading(truth, (g + 50.0 * mg) * *poses[4].up);
  const MultiPosition fit = calibrate_positions(poses, with_noise(500.0)).value();
  const bool named = fit.poses[4].suspect;
  EXPECT_TRUE(named || !fit.doubtful.empty());
  for (std::size_t k = 0; k < poses.size(); ++k) EXPECT_TRUE(k == 4 || !fit.poses[k].suspect) << k;
}

TEST(MultiPosition, WidensWhereTheNoiseDoesNotExplainTheResiduals) {
  std::mt19937_64 random(6);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {.count = 40, .noise_mps2 = 0.5 * mg}, random);
  const MultiPosition fit = calibrate_positions(poses, with_noise(1000.0)).value();
  ASSERT_TRUE(fit.lack_of_fit);
  EXPECT_LT(fit.lack_of_fit->p, 1e-9);
  EXPECT_NEAR(fit.lack_of_fit->statistic, 25.0, 15.0);
  EXPECT_EQ(fit.dof, 31.0);
  const auto honest = drawn_poses(truth, {.count = 40}, random);
  const MultiPosition narrow = calibrate_positions(honest, with_noise(1000.0)).value();
  EXPECT_GT(fit.scale[0]->std, 3.0 * narrow.scale[0]->std);
}

TEST(MultiPosition, CountsGravityOnceForAllScales) {
  std::mt19937_64 random(7);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {}, random);
  MultiPositionOptions options = with_noise(500.0);
  const MultiPosition sure = calibrate_positions(poses, options).value();
  options.gravity_std_mps2 = 0.01;
  const MultiPosition fit = calibrate_positions(poses, options).value();
  const double relative = 0.01 / g;
  EXPECT_NEAR(fit.covariance(3, 4), truth(3) * truth(4) * relative * relative,
              1e-3 * fit.covariance(3, 4));
  EXPECT_EQ(fit.bias[0]->std, sure.bias[0]->std);
  options.gravity_mps2 = g + 0.01;
  const MultiPosition other = calibrate_positions(poses, options).value();
  EXPECT_NEAR(other.scale[1]->value, sure.scale[1]->value * g / (g + 0.01), 1e-8);
}

TEST(MultiPosition, TakesSixParametersWhereNineAreNotCarried) {
  std::mt19937_64 random(8);
  Parameters truth = drawn_sensor(random);
  truth.tail<3>().setZero();
  std::vector<Eigen::Vector3d> up = six_sides();
  for (const Eigen::Vector3d& side : six_sides()) up.push_back(side);
  const MultiPosition fit = calibrate_positions(poses_along(truth, up), with_noise(0.0)).value();
  EXPECT_EQ(fit.model, PoseModel::norm_6);
  EXPECT_FALSE(fit.misalignment_rad[0]);
  EXPECT_NEAR(fit.bias[2]->value, truth(2), 1e-6);
  EXPECT_NEAR(fit.scale[0]->value, truth(3), 1e-8);
  EXPECT_GT(fit.covariance(6, 6), 0.0);
}

TEST(MultiPosition, HoldsTheAnglesItLeavesOutInItsUncertainty) {
  std::mt19937_64 random(9);
  int inside = 0, all = 0;
  for (int run = 0; run < 60; ++run) {
    Parameters truth = drawn_sensor(random);
    truth.tail<3>() *= 0.01 / 0.006;
    const auto poses = drawn_poses(truth, {.count = 8}, random);
    MultiPositionOptions options = with_noise(500.0);
    options.model = PoseModel::norm_6;
    const Result<MultiPosition> fit = calibrate_positions(poses, options);
    if (!fit) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      inside += std::abs(fit->bias[k]->value - truth(static_cast<Eigen::Index>(k))) <
                2.0 * fit->bias[k]->std;
      ++all;
    }
  }
  EXPECT_GT(inside, 0.9 * all);
}

TEST(MultiPosition, ReportsWhatThePosesDoNotDetermine) {
  std::mt19937_64 random(10);
  const Parameters truth = drawn_sensor(random);
  const auto said = [&](const std::vector<Eigen::Vector3d>& up) {
    const auto fit = calibrate_positions(poses_along(truth, up), with_noise(0.0));
    return fit ? std::string("no error") : fit.error().message;
  };
  EXPECT_NE(said({{1, 0, 0}, {0, 1, 0}}).find("2 positions for 6 parameters"), std::string::npos);
  const std::vector<Eigen::Vector3d> same(12, Eigen::Vector3d(0.3, 0.2, 0.9));
  EXPECT_NE(said(same).find("all positions read the same"), std::string::npos);
  // Rotations about z only: z is constant, and its scale undetermined.
  std::vector<Eigen::Vector3d> about_z;
  for (int k = 0; k < 12; ++k) about_z.emplace_back(std::cos(0.5 * k), std::sin(0.5 * k), 0.4);
  EXPECT_NE(said(about_z).find("do not determine scale z"), std::string::npos) << said(about_z);
}

TEST(MultiPosition, RefusesNonFiniteValues) {
  std::mt19937_64 random(11);
  auto poses = drawn_poses(drawn_sensor(random), {}, random);
  poses[2].mean.y() = NAN;
  const auto fit = calibrate_positions(poses, with_noise(0.0));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, Errc::not_finite);
  EXPECT_NE(fit.error().message.find("position 3"), std::string::npos);
  EXPECT_EQ(calibrate_positions({}, with_noise(0.0)).error().code, Errc::too_few_samples);
  EXPECT_EQ(calibrate_positions(poses, {.gravity_mps2 = 0.0}).error().code, Errc::invalid_argument);
}

TEST(MultiPosition, NextPoseLessensTheUncertaintyByWhatItSays) {
  std::mt19937_64 random(12);
  const Parameters truth = drawn_sensor(random);
  auto poses = drawn_poses(truth, {.count = 10}, random);
  MultiPositionOptions options = with_noise(1e7);
  const MultiPosition before = calibrate_positions(poses, options).value();
  ASSERT_TRUE(before.next_pose);
  Pose next = poses.front();
  next.mean = reading(truth, g * before.next_pose->up);
  poses.push_back(next);
  const MultiPosition after = calibrate_positions(poses, options).value();
  const auto worst = [](const MultiPosition& fit) {
    double out = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      out = std::max({out, fit.bias[k]->std / fit.scale[k]->value / g,
                      fit.scale[k]->std / fit.scale[k]->value, fit.misalignment_rad[k]->std});
    }
    return out;
  };
  EXPECT_NEAR(1.0 - worst(after) / worst(before), before.next_pose->gain, 0.05);
  EXPECT_FALSE(before.next_pose->words.empty());
}

TEST(MultiPosition, SixExactPositionsAreFerrarisFormulas) {
  std::mt19937_64 random(13);
  const Parameters truth = drawn_sensor(random);
  MultiPositionOptions options = with_noise(0.0);
  options.model = PoseModel::six_position;
  const auto poses = poses_along(truth, six_sides());
  const MultiPosition fit = calibrate_positions(poses, options).value();
  EXPECT_DOUBLE_EQ(fit.bias[0]->value, (poses[0].mean.x() + poses[1].mean.x()) / 2.0);
  Eigen::Vector3d row;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto side = static_cast<std::size_t>(2 * k);
    row(k) = poses[side].mean.y() - poses[side + 1].mean.y();
  }
  EXPECT_DOUBLE_EQ(fit.scale[1]->value, row.norm() / (2.0 * g));
  EXPECT_FALSE(fit.misalignment_rad[0]);
  const auto five = calibrate_positions(View<Pose>(poses).first(5), options);
  ASSERT_FALSE(five);
  EXPECT_NE(five.error().message.find("-z up"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::calibrate::multi_position_test
