#include "proofmass/core/so3.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace proofmass::so3_test {
namespace {

const Eigen::Vector3d some(0.3, -1.1, 0.7);

TEST(Rotation, CrossMatrixIsTheCrossProduct) {
  const Eigen::Vector3d a(1.0, 2.0, 3.0), b(-0.5, 0.25, 4.0);
  EXPECT_EQ(Eigen::Vector3d(cross_matrix(a) * b), cross(a, b));
  EXPECT_EQ(cross(a, b).dot(a), 0.0);
}

TEST(Rotation, AboutAnAxisTurnsTheOthers) {
  const Eigen::Matrix3d R = rotation_by({0.0, 0.0, std::numbers::pi / 2.0});
  EXPECT_TRUE((R * Eigen::Vector3d(1.0, 0.0, 0.0)).isApprox(Eigen::Vector3d(0.0, 1.0, 0.0), 1e-15));
}

TEST(Rotation, TwoHalvesMakeTheWhole) {
  for (const double size : {1e-12, 1e-5, 0.9e-4, 1.1e-4, 1.0, 3.0}) {
    const Eigen::Matrix3d half = rotation_by(0.5 * size * some);
    EXPECT_LT((half * half - rotation_by(size * some)).norm(), 1e-15) << size;
  }
}

TEST(Rotation, VectorAndMatrixAreEachOthersInverse) {
  for (const double size : {0.0, 1e-12, 1e-6, 0.1, 1.0, 2.3})
    EXPECT_LT((rotation_vector(rotation_by(size * some)) - size * some).norm(), 4e-15) << size;
  const Eigen::Vector3d half_turn = std::numbers::pi * some.normalized();
  const Eigen::Vector3d found = rotation_vector(rotation_by(half_turn));
  EXPECT_NEAR(found.norm(), std::numbers::pi, 1e-14);
  EXPECT_NEAR(std::abs(found.dot(half_turn)), std::numbers::pi * std::numbers::pi, 1e-13);
}

TEST(Rotation, QuaternionAndMatrixAreEachOthersInverse) {
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(3.1, 0.0, 0.1),
        Eigen::Vector3d(0.0, 3.0, 0.4), Eigen::Vector3d(0.2, 0.1, -3.1)}) {
    const Eigen::Matrix3d R = rotation_by(turn);
    EXPECT_LT((rotation_of(quaternion_of(R, {1.0, 0.0, 0.0, 0.0})) - R).norm(), 2e-15);
  }
}

TEST(Rotation, QuaternionsOfATurnFollowEachOtherOnOneSide) {
  std::array<double, 4> before = {1.0, 0.0, 0.0, 0.0};
  for (int k = 1; k <= 100; ++k) {
    const auto q = quaternion_of(rotation_by({0.0, 0.1 * k, 0.0}), before);
    EXPECT_NEAR(q[0], std::cos(0.05 * k), 1e-14);
    before = q;
  }
}

TEST(Rotation, OrthonormalMendsWhatRoundingHasSpoilt) {
  const Eigen::Matrix3d R = rotation_by(some);
  const Eigen::Matrix3d spoilt = R + 1e-8 * Eigen::Matrix3d::Constant(0.7);
  const Eigen::Matrix3d mended = orthonormal(spoilt);
  EXPECT_LT((mended * mended.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_LT((mended - R).norm(), 3e-8);
}

}  // namespace
}  // namespace proofmass::so3_test
