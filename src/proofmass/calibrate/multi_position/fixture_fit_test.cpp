#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position_test_support.hpp"

namespace proofmass::calibrate::given_directions_test {
namespace {

using test::drawn_poses;
using test::drawn_sensor;
using test::g;

MultiPositionOptions given(double noise_dof) {
  return {.model = PoseModel::given_12, .gravity_mps2 = g, .noise_dof = noise_dof};
}

// Directions in the frame of a fixture in which the sensor is mounted with a rotation.
std::vector<Pose> mounted(std::vector<Pose> poses, const Eigen::Matrix3d& R_sensor_fixture) {
  for (Pose& pose : poses) pose.up = R_sensor_fixture.transpose() * *pose.up;
  return poses;
}

TEST(GivenDirections, FindTheMountingBesideNineParameters) {
  std::mt19937_64 random(1);
  const Parameters truth = drawn_sensor(random);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  const auto poses = mounted(
      drawn_poses(truth, {.count = 8, .noise_mps2 = 0.0, .claimed_mps2 = 0.0, .tilt_rad = 0.0},
                  random),
      R);
  const MultiPosition fit = calibrate_positions(poses, given(0.0)).value();
  for (Eigen::Index k = 0; k < 9; ++k)
    EXPECT_NEAR(fit.estimate[static_cast<std::size_t>(k)], truth(k), k < 6 ? 1e-6 : 1e-10) << k;
  EXPECT_TRUE(fit.axes_in_fixture->isApprox(R, 1e-10));
  EXPECT_NEAR(fit.mounting_rad->norm(), 0.8, 1e-10);
  EXPECT_LT(*fit.placement_std_rad, 1e-9);
}

TEST(GivenDirections, DetermineTheAccuracyOfThePlacement) {
  std::mt19937_64 random(2);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {.count = 200, .tilt_rad = 0.02}, random);
  const MultiPosition fit = calibrate_positions(poses, given(1000.0)).value();
  EXPECT_NEAR(*fit.placement_std_rad, 0.02, 0.002);
  EXPECT_GT(fit.lack_of_fit->p, 0.01);
}

TEST(GivenDirections, ThatAreRoughDoNoHarm) {
  std::mt19937_64 random(3);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {.tilt_rad = 0.035}, random);
  const MultiPosition by_norm =
      calibrate_positions(poses, {.gravity_mps2 = g, .noise_dof = 1000.0}).value();
  const MultiPosition fit = calibrate_positions(poses, given(1000.0)).value();
  for (std::size_t k = 0; k < 9; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double std = std::sqrt(by_norm.covariance(row, row));
    EXPECT_NEAR(fit.estimate[k], by_norm.estimate[k], 0.3 * std) << k;
  }
}

TEST(GivenDirections, ThatAreExactAreMadeUseOf) {
  std::mt19937_64 random(4);
  const Parameters truth = drawn_sensor(random);
  const auto poses = drawn_poses(truth, {.tilt_rad = 0.0}, random);
  const MultiPosition by_norm =
      calibrate_positions(poses, {.gravity_mps2 = g, .noise_dof = 1000.0}).value();
  const MultiPosition fit = calibrate_positions(poses, given(1000.0)).value();
  EXPECT_LT(fit.misalignment_rad[0]->std, 0.9 * by_norm.misalignment_rad[0]->std);
}

TEST(GivenDirections, NameThePositionThatWasSetWrongly) {
  std::mt19937_64 random(5);
  const Parameters truth = drawn_sensor(random);
  auto poses = drawn_poses(truth, {.tilt_rad = 0.002}, random);
  poses[5].up = (*poses[5].up + Eigen::Vector3d(0.05, -0.05, 0.05)).normalized();
  const MultiPosition fit = calibrate_positions(poses, given(1000.0)).value();
  for (std::size_t k = 0; k < poses.size(); ++k) EXPECT_EQ(fit.poses[k].suspect, k == 5) << k;
}

TEST(GivenDirections, SayWhyTheyCannot) {
  std::mt19937_64 random(6);
  const Parameters truth = drawn_sensor(random);
  auto poses = drawn_poses(truth, {.count = 12}, random);
  const auto said = [](const std::vector<Pose>& p) {
    const auto fit = calibrate_positions(p, given(0.0));
    return fit ? std::string("no error") : fit.error().message;
  };
  auto mirrored = poses;
  for (Pose& pose : mirrored) pose.up->x() = -pose.up->x();
  EXPECT_NE(said(mirrored).find("mirror image"), std::string::npos);
  auto flat = poses;
  for (Pose& pose : flat) pose.up->z() = 0.0;
  EXPECT_NE(said(flat).find("plane"), std::string::npos);
  auto missing = poses;
  missing[3].up.reset();
  EXPECT_NE(said(missing).find("position 4"), std::string::npos);
  poses.resize(4);
  EXPECT_NE(said(poses).find("at least 5"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::calibrate::given_directions_test
