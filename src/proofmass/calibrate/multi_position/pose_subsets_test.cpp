#include <array>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "proofmass/calibrate/multi_position_budget.hpp"
#include "proofmass/calibrate/multi_position_check.hpp"
#include "proofmass/calibrate/multi_position_test_support.hpp"

// Any set of positions gives either figures or an error message of this library.
namespace proofmass::calibrate::pose_subsets_test {
namespace {

using test::drawn_direction;
using test::drawn_sensor;
using test::reading;

// Arrangement of the directions of a set.
enum class Directions { anywhere, in_a_plane, on_a_cone, few_repeated, near_one, axes_alone };
constexpr std::array all_directions{Directions::anywhere,  Directions::in_a_plane,
                                    Directions::on_a_cone, Directions::few_repeated,
                                    Directions::near_one,  Directions::axes_alone};

Eigen::Vector3d direction_of(Directions kind, std::size_t k, std::mt19937_64& random) {
  const Eigen::Vector3d any = drawn_direction(random);
  switch (kind) {
    case Directions::anywhere:
      return any;
    case Directions::in_a_plane:
      return Eigen::Vector3d(any.x(), any.y(), 0.0).normalized();
    case Directions::on_a_cone:
      return Eigen::Vector3d(any.x(), any.y(), any.head<2>().norm()).normalized();
    case Directions::few_repeated:
      return Eigen::Vector3d(1.0, static_cast<double>(k % 4), static_cast<double>(k % 3) - 1.0)
          .normalized();
    case Directions::near_one:
      return (Eigen::Vector3d(0.3, -0.4, 0.9) + 1e-3 * any).normalized();
    case Directions::axes_alone:
      return Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k % 3)) * (k % 2 == 0 ? 1.0 : -1.0);
  }
  return any;
}

// Properties of a set: true and stated noise in m/s², arrangement of the directions, one outlier.
struct Kind {
  std::size_t count;
  Directions directions;
  double noise_mps2, claimed_mps2;
  bool one_off;
};

std::vector<Pose> poses_of(const Kind& kind, std::mt19937_64& random) {
  const Parameters truth = drawn_sensor(random);
  std::normal_distribution<double> normal;
  std::vector<Pose> poses(kind.count);
  for (std::size_t k = 0; k < kind.count; ++k) {
    Pose& pose = poses[k];
    pose.up = direction_of(kind.directions, k, random);
    pose.mean = reading(truth, test::g * *pose.up);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      pose.mean(axis) += truth(3 + axis) * kind.noise_mps2 * normal(random);
    const Eigen::Vector3d claimed = kind.claimed_mps2 * truth.segment<3>(3);
    pose.mean_covariance = claimed.cwiseAbs2().asDiagonal();
  }
  if (kind.one_off) poses.front().mean *= 1.1;
  return poses;
}

void expect_own_words(const std::string& message) {
  EXPECT_FALSE(message.empty());
  for (const char* foreign : {"nan", "inf", "Error in function", "boost", "Eigen", "eres", "std::"})
    EXPECT_EQ(message.find(foreign), std::string::npos) << message;
}

void expect_numbers(const MultiPosition& fit) {
  EXPECT_TRUE(fit.covariance.allFinite());
  for (const double value : fit.estimate) EXPECT_TRUE(std::isfinite(value));
  for (const PoseResidual& pose : fit.poses) {
    EXPECT_TRUE(std::isfinite(pose.residual_mps2) && pose.force_mps2.allFinite());
    for (const auto& figure : {pose.leave_one_out_mps2, pose.studentised, pose.detectable_mps2})
      EXPECT_TRUE(std::isfinite(figure.value_or(0.0)));
  }
  EXPECT_TRUE(std::isfinite(fit.residual_rms_mps2) && std::isfinite(fit.condition));
  const double p = fit.lack_of_fit ? fit.lack_of_fit->p : 1.0;
  EXPECT_TRUE(p >= 0.0 && p <= 1.0);
  for (const std::string& note : fit.notes) expect_own_words(note);
}

void expect_checked_budgets(const std::vector<Pose>& poses,
                            const MultiPositionOptions& options,
                            const MultiPosition& fit) {
  const auto budgets = budget_of(fit, {}, "counts");
  ASSERT_TRUE(budgets.has_value());
  for (const UncertaintyBudget& budget : *budgets)
    EXPECT_TRUE(std::isfinite(budget.expanded_95)) << budget.measurand.quantity;
  const auto check =
      check_by_monte_carlo(poses, options, fit, {.reading_unit = "counts", .draws = 100});
  expect_own_words(check ? check->verdict : check.error().message);
}

class PoseSubsets : public testing::TestWithParam<std::optional<PoseModel>> {};

TEST_P(PoseSubsets, EndInFiguresOrInAReasonInOurWords) {
  std::mt19937_64 random(20);
  int fitted = 0, refused = 0;
  for (std::size_t count = 3; count <= 24; count += count < 10 ? 1 : 3) {
    for (const Directions directions : all_directions) {
      const std::size_t turn = count + static_cast<std::size_t>(directions);
      const Kind kind{.count = count,
                      .directions = directions,
                      .noise_mps2 = turn % 3 == 0 ? 0.0 : 1e-3,
                      .claimed_mps2 = turn % 2 == 0 ? 1e-3 : 0.0,
                      .one_off = turn % 5 == 0};
      const std::vector<Pose> poses = poses_of(kind, random);
      const MultiPositionOptions options{.model = GetParam(),
                                         .gravity_mps2 = test::g,
                                         .gravity_std_mps2 = 1e-3,
                                         .noise_dof = turn % 2 == 0 ? 200.0 : 0.0};
      const Result<MultiPosition> fit = calibrate_positions(poses, options);
      SCOPED_TRACE(testing::Message()
                   << count << " positions, directions " << static_cast<int>(directions));
      ++(fit ? fitted : refused);
      if (!fit) {
        expect_own_words(fit.error().message);
        continue;
      }
      expect_numbers(*fit);
      if (turn % 8 == 0) expect_checked_budgets(poses, options, *fit);
    }
  }
  EXPECT_GT(fitted, 0);
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Models,
                         PoseSubsets,
                         testing::Values(std::nullopt,
                                         PoseModel::norm_9,
                                         PoseModel::norm_6,
                                         PoseModel::given_12,
                                         PoseModel::six_position));

}  // namespace
}  // namespace proofmass::calibrate::pose_subsets_test
