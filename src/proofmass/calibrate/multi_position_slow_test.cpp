#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position_test_support.hpp"
#include "proofmass/core/chi_square.hpp"

// Coverage of the intervals over a thousand sensors.
namespace proofmass::calibrate::multi_position_slow_test {
namespace {

using test::drawn_poses;
using test::drawn_sensor;
using test::g;
using test::mg;

struct Study {
  test::PoseDraw draw = {};
  double noise_dof = 1000.0;
  std::optional<PoseModel> model = {};
  double push_mps2 = 0.0;  ///< disturbance of one position
  int runs = 1000;
};

struct Outcome {
  std::array<int, 9> inside{};
  int fits = 0, named = 0, wrongly = 0, lacking = 0;
  double error_squares = 0.0;

  [[nodiscard]] double share(int count) const { return static_cast<double>(count) / fits; }
};

void judge(const MultiPosition& fit, const Parameters& truth, Outcome& out) {
  for (std::size_t k = 0; k < 9; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double half = student_t_quantile(0.975, fit.dof) * std::sqrt(fit.covariance(row, row));
    out.inside[k] += std::abs(fit.estimate[k] - truth(row)) <= half;
  }
}

Outcome outcome_of(const Study& study) {
  std::mt19937_64 random(1);
  Outcome out;
  for (int run = 0; run < study.runs; ++run) {
    const Parameters truth = drawn_sensor(random);
    std::vector<Pose> poses = drawn_poses(truth, study.draw, random);
    const std::size_t bad = random() % poses.size();
    if (study.push_mps2 != 0.0) {
      const Eigen::Vector3d push = study.push_mps2 * *poses[bad].up;
      poses[bad].mean += test::reading(truth, push) - truth.head<3>();
    }
    const auto fit = calibrate_positions(
        poses, {.model = study.model, .gravity_mps2 = g, .noise_dof = study.noise_dof});
    if (!fit) continue;
    ++out.fits;
    judge(*fit, truth, out);
    out.lacking += fit->lack_of_fit && fit->lack_of_fit->p < 0.05;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const bool pushed = study.push_mps2 != 0.0 && k == bad;
      (pushed ? out.named : out.wrongly) += fit->poses[k].suspect;
    }
    out.error_squares += std::pow(test::error_on_new_directions(*fit, truth, random), 2);
  }
  return out;
}

void expect_honest(const Outcome& out) {
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_GT(out.share(out.inside[k]), 0.93) << k;
    EXPECT_LT(out.share(out.inside[k]), 0.97) << k;
  }
}

TEST(MultiPositionCoverage, Holds95PercentWithNoiseMeasured) {
  const Outcome out = outcome_of({});
  expect_honest(out);
  EXPECT_NEAR(out.share(out.lacking), 0.05, 0.02);
  EXPECT_LT(out.share(out.wrongly), 0.03);
  EXPECT_LT(std::sqrt(out.error_squares / out.fits), 0.07 * mg);
}

TEST(MultiPositionCoverage, Holds95PercentWithNoiseUnknown) {
  expect_honest(outcome_of({.draw = {.claimed_mps2 = 0.0}, .noise_dof = 0.0}));
}

TEST(MultiPositionCoverage, Holds95PercentWhereTheNoiseIsThriceWhatIsClaimed) {
  const Outcome out = outcome_of({.draw = {.noise_mps2 = 0.3 * mg}});
  expect_honest(out);
  EXPECT_GT(out.share(out.lacking), 0.95);
}

TEST(MultiPositionCoverage, NamesAPoseOff5MilliGInAtLeast95Percent) {
  const Outcome out = outcome_of({.push_mps2 = 5.0 * mg});
  EXPECT_GT(out.share(out.named), 0.95);
  EXPECT_LT(out.share(out.wrongly), 0.03);
  expect_honest(out);
}

TEST(MultiPositionCoverage, DoesNotHangOnThePlacement) {
  for (const double tilt_rad : {0.0, 0.009, 0.035}) {
    const Outcome out = outcome_of({.draw = {.tilt_rad = tilt_rad}, .runs = 200});
    EXPECT_LT(std::sqrt(out.error_squares / out.fits), 0.07 * mg) << tilt_rad;
  }
}

TEST(MultiPositionCoverage, Holds95PercentWithDirectionsGiven) {
  expect_honest(outcome_of({.draw = {.tilt_rad = 0.009}, .model = PoseModel::given_12}));
}

TEST(MultiPositionCoverage, OfSixExactPositionsHoldsWhatPlacingDoes) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  int inside = 0, all = 0;
  for (int run = 0; run < 500; ++run) {
    const Parameters truth = drawn_sensor(random);
    std::vector<Pose> poses;
    for (int side = 0; side < 6; ++side) {
      const Eigen::Vector3d up = (side % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(side / 2);
      const Eigen::Vector3d tilt(normal(random), normal(random), normal(random));
      Pose& pose = poses.emplace_back();
      pose.up = up;
      pose.mean = test::reading(truth, g * (up + rad_per_deg * tilt).normalized());
      pose.mean_covariance = 1e-4 * Eigen::Matrix3d::Identity();
    }
    const MultiPosition fit =
        calibrate_positions(
            poses, {.model = PoseModel::six_position, .gravity_mps2 = g, .noise_dof = 1000.0})
            .value();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      inside += std::abs(fit.bias[k]->value - truth(row)) <= 1.96 * fit.bias[k]->std;
      inside += std::abs(fit.scale[k]->value - truth(3 + row)) <= 1.96 * fit.scale[k]->std;
      all += 2;
    }
  }
  EXPECT_GT(inside, 0.93 * all);
}

}  // namespace
}  // namespace proofmass::calibrate::multi_position_slow_test
