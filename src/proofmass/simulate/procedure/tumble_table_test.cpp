#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/simulate/rig/bench_test_support.hpp"

namespace proofmass::simulate::tumble_table_test {
namespace {

constexpr double g = standard_gravity_mps2;

ProcedureOptions tumble() {
  return noise_free(Procedure::tumble);
}

/// The reading of x at rest, per position.
std::vector<double> readings_of_x(const ProcedureOptions& options) {
  std::vector<double> E;
  for (const PoseMean& mean : draw_pose_means(options).value().means) E.push_back(mean.mean.x());
  return E;
}

// The four-point formulas of IEEE Std 1293, each with the terms that the full equation adds.
TEST(TumbleTable, FourPositionsGiveTheFourPointFormulas) {
  ProcedureOptions options = noise_free(Procedure::four_position);
  options.sensor.equation[0] = {.K2 = 1e-4, .K3 = 2e-6, .delta_o = 3e-3, .Kpp = 5e-5};
  const std::vector<double> E = readings_of_x(options);
  const sensor::ModelEquation x = draw_pose_means(options).value().truth.equations[0];
  ASSERT_EQ(E.size(), 4U);
  EXPECT_NEAR((E[1] - E[3]) / (2.0 * g), x.K1 * (1.0 + x.K3 * g * g), 1e-14);
  EXPECT_NEAR((E[0] - E[2]) / (2.0 * g), x.K1 * x.delta_o, 1e-14);
  EXPECT_NEAR((E[0] + E[2]) / 2.0, x.K1 * (x.K0 + x.Kpp * g * g), 1e-13);
  EXPECT_NEAR((E[1] + E[3]) / 2.0, x.K1 * (x.K0 + x.K2 * g * g), 1e-13);
}

TEST(TumbleTable, GoesRoundAndClosesOnItsFirstPosition) {
  const auto truth = draw_pose_means(tumble()).value().truth;
  ASSERT_EQ(truth.poses.size(), 25U);
  for (std::size_t k = 0; k < 25; ++k) {
    EXPECT_NEAR(truth.poses[k].commanded_rad, static_cast<double>(k) * 15.0 * rad_per_deg, 1e-12);
    EXPECT_EQ(truth.poses[k].angle_rad, truth.poses[k].commanded_rad);
  }
  EXPECT_LT((truth.poses[24].force_mps2 - truth.poses[0].force_mps2).norm(), 1e-13);
  EXPECT_NEAR(truth.poses[6].force_mps2.x(), g, 1e-13);
  EXPECT_NEAR(truth.poses[0].force_mps2.y(), g, 1e-13);
}

TEST(TumbleTable, ForwardBackwardRemountedAndPlanesMultiply) {
  ProcedureOptions options = tumble();
  options.table.backward = true;
  EXPECT_EQ(readings_of_x(options).size(), 49U);
  options.table.remounted = true;
  EXPECT_EQ(readings_of_x(options).size(), 98U);
  options.table.planes = 2;
  EXPECT_EQ(readings_of_x(options).size(), 196U);
  options.table.first_plane = 2;
  EXPECT_EQ(readings_of_x(options).size(), 98U);
}

// At 0° the second axis points upwards, at 90° the first; turned on the table, both point
// downwards.
TEST(TumbleTable, PutsInputAndThenPendulousOrOutputAxisIntoThePlane) {
  ProcedureOptions options = tumble();
  options.table.planes = 2;
  options.table.remounted = true;
  for (Eigen::Index i = 0; i < 3; ++i) {
    options.table.input_axis = static_cast<TableAxis>(i);
    const auto poses = draw_pose_means(options).value().truth.poses;
    ASSERT_EQ(poses.size(), 100U);
    for (std::size_t run = 0; run < 4; ++run) {
      const int plane = run < 2 ? 1 : 2;
      const double sign = run % 2 == 0 ? 1.0 : -1.0;
      const Eigen::Vector3d &zero = poses[25 * run].force_mps2,
                            &quarter = poses[25 * run + 6].force_mps2;
      EXPECT_LT((zero - sign * g * Eigen::Vector3d::Unit((i + plane) % 3)).norm(), 1e-13);
      EXPECT_LT((quarter - sign * g * Eigen::Vector3d::Unit(i)).norm(), 1e-13);
      EXPECT_EQ(poses[25 * run].plane, plane);
      EXPECT_EQ(poses[25 * run].mount_rad, sign > 0.0 ? 0.0 : std::numbers::pi);
    }
  }
}

TEST(TumbleTable, ItsScaleErrsAsDescribed) {
  ProcedureOptions options = tumble();
  options.table.once_rad = 1e-3;
  options.table.once_phase_rad = 0.4;
  options.table.twice_rad = 5e-4;
  options.table.twice_phase_rad = -0.3;
  options.table.zero_error_rad = 2e-3;
  options.table.backlash_rad = 4e-4;
  options.table.backward = true;
  const auto poses = draw_pose_means(options).value().truth.poses;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double c = poses[k].commanded_rad;
    EXPECT_NEAR(
        poses[k].angle_rad - c,
        2e-3 + 1e-3 * std::cos(c - 0.4) + 5e-4 * std::cos(2.0 * c + 0.3) + (k <= 24 ? -2e-4 : 2e-4),
        1e-15);
  }
}

TEST(TumbleTable, APositionErrsAlikeEveryTimeASettingDoesNot) {
  ProcedureOptions options = tumble();
  options.table.position_std_rad = 1e-3;
  auto poses = draw_pose_means(options).value().truth.poses;
  const auto error = [&](std::size_t k) { return poses[k].angle_rad - poses[k].commanded_rad; };
  EXPECT_NEAR(error(24), error(0), 1e-14);
  EXPECT_NE(error(1), error(0));
  options.table.setting_std_rad = 1e-3;
  poses = draw_pose_means(options).value().truth.poses;
  EXPECT_GT(std::abs(error(24) - error(0)), 1e-6);
}

// Known exactly: θ follows minimum jerk, so its maximum acceleration is 10/√3 Δθ/T².
TEST(TumbleTable, TurningIsFeltThroughTheRatesTerms) {
  ProcedureOptions options = tumble();
  options.rate_hz = 1000.0;
  options.table.positions = 4;
  options.table.radius_m = 0.0;
  options.table.vibration_mps2 = 0.0;
  const auto without = column(simulated(options).recording, "acc_x");
  options.sensor.equation[0].Kang = 0.01;
  const ProcedureResult result = simulated(options);
  const auto with = column(result.recording, "acc_x");
  double greatest = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < with.size(); ++k) {
    greatest = std::max(greatest, with[k] - without[k]);
    sum += with[k] - without[k];
  }
  const double alpha = 10.0 / std::numbers::sqrt3 * 0.5 * std::numbers::pi / 4.0;
  EXPECT_NEAR(greatest, result.truth.equations[0].K1 * 0.01 * alpha, 1e-5);
  EXPECT_NEAR(sum / static_cast<double>(with.size()), 0.0, 1e-9);
}

TEST(TumbleTable, ATiltedAxisTakesItsCosineAndShowsAlongTheOutputAxis) {
  ProcedureOptions options = tumble();
  options.table.axis_tilt_rad = 0.01;
  for (const TruePose& pose : draw_pose_means(options).value().truth.poses) {
    EXPECT_NEAR(pose.force_mps2.z(), g * std::sin(0.01), 1e-14);
    EXPECT_NEAR(pose.force_mps2.x(), g * std::cos(0.01) * std::sin(pose.angle_rad), 1e-13);
  }
}

TEST(TumbleTable, AnAngleThatFollowsIsTheTrueOneOfATableWithoutErrors) {
  ProcedureOptions options = tumble();
  const ProcedureResult stepping = simulated(options);
  for (const double ahead : column(stepping.recording, "angle"))
    ASSERT_NEAR(std::remainder(ahead, 15.0), 0.0, 1e-9);
  options.table.angle_follows = true;
  const ProcedureResult result = simulated(options);
  const auto& angle = column(result.truth_series, "angle");
  for (std::size_t k = 0; k < angle.size(); ++k)
    ASSERT_NEAR(column(result.recording, "angle")[k] * rad_per_deg, angle[k], 1e-12);
}

TEST(TumbleTable, TheCommandedAngleIsRecordedInDegrees) {
  const ProcedureResult result = simulated(tumble());
  const auto& commanded = column(result.recording, "angle");
  EXPECT_EQ(result.recording.find("angle")->unit.symbol, "deg");
  for (const TruePose& pose : result.truth.poses) {
    const auto k = static_cast<std::size_t>(std::ceil(pose.start_s * 100.0));
    EXPECT_NEAR(commanded[k], pose.commanded_rad / rad_per_deg, 1e-9);
    EXPECT_NEAR(column(result.truth_series, "angle")[k], pose.angle_rad, 1e-12);
  }
  ProcedureOptions silent = tumble();
  silent.table.angle_recorded = false;
  EXPECT_EQ(simulated(silent).recording.find("angle"), nullptr);
  silent.table.planes = 2;
  silent.table.remounted = true;
  const ProcedureResult both = simulated(silent);
  EXPECT_EQ(column(both.recording, "plane").front(), 1.0);
  EXPECT_EQ(column(both.recording, "plane").back(), 2.0);
  EXPECT_NEAR(column(both.recording, "mount").back(), 180.0, 1e-12);
}

}  // namespace
}  // namespace proofmass::simulate::tumble_table_test
