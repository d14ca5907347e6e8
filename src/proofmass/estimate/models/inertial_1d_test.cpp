#include "proofmass/estimate/models/inertial_1d.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/estimate/track/turns.hpp"

namespace proofmass::estimate::inertial_axis_test {
namespace {

const InertialNoise noise{.white_m2ps3 = 4e-4,
                          .motion_lean_m2ps3 = 1e-4,
                          .motion_walk_m2ps5 = 2e-5,
                          .motion_jump_m2ps4 = 1e-4,
                          .rest_walk_m2ps5 = 1e-7,
                          .rest_speed_std_mps = 1e-3};
const InertialStart start{.speed_std_mps = 0.1, .bias_mps2 = 0.0, .bias_std_mps2 = 0.05};

// A rest, a motion with irregular steps and a gap, and a rest; with a fix in between.
std::vector<InertialEpoch> some_epochs() {
  std::vector<InertialEpoch> epochs(40);
  std::mt19937_64 engine(7);
  std::normal_distribution<double> draw(0.0, 1.0);
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    InertialEpoch& e = epochs[k];
    e.resting = (k > 0 && k < 6) || k > 33;
    e.dt_s = k == 0 ? 0.0 : e.resting ? 0.5 : 0.02 + 0.003 * static_cast<double>(k % 4);
    if (e.resting) {
      e.level_mps2 = 0.02 + 0.01 * draw(engine);
      e.level_variance = 1e-4;
    } else {
      e.velocity_step_mps = 0.05 * draw(engine) * e.dt_s;
      e.position_step_m = 0.5 * e.velocity_step_mps * e.dt_s;
    }
  }
  epochs[0].velocity_std_mps = epochs[33].velocity_std_mps = 1e-3;
  epochs[6].leaves_rest = epochs[33].arrives_at_rest = true;
  epochs[17].unknown_accel_m2ps3 = 0.25;
  epochs[20].position_m = 0.01;
  epochs[20].position_variance = 1e-4;
  return epochs;
}

struct Smoothed {
  std::vector<Gaussian<3>> at;
};

Smoothed smoothed(const std::vector<InertialEpoch>& epochs) {
  Smoothed out;
  out.at.resize(epochs.size());
  const InertialAxis model{epochs, noise};
  smooth(
      model, inertial_start(start), Gate{}, [](const auto&...) {},
      [&](std::size_t k, const StepOf<InertialAxis>& step, const BackwardInformation<3>& later) {
        out.at[k] = {later.mean(step.filtered), later.cov<3>(step.filtered)};
      });
  return out;
}

TEST(InertialAxis, JoinedEpochsSayTheSame) {
  const std::vector<InertialEpoch> epochs = some_epochs();
  const std::vector<std::size_t> kept{0, 1, 2, 3, 4, 5, 16, 17, 20, 33, 34, 35, 36, 37, 38, 39};
  const Smoothed fine = smoothed(epochs), coarse = smoothed(join_epochs(epochs, kept));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Gaussian<3>&a = fine.at[kept[i]], &b = coarse.at[i];
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(a.mean(j), b.mean(j), 1e-9 * (1e-3 + std::sqrt(a.cov(j, j)))) << kept[i];
    EXPECT_LT((a.cov - b.cov).norm(), 1e-9 * a.cov.norm() + 1e-15) << kept[i];
  }
}

// Joint normal distribution of all states, conditioned on all measurements at once.
TEST(InertialAxis, EqualsTheDenseBatchWithItsCovariancesAcrossTime) {
  const std::vector<InertialEpoch> epochs = some_epochs();
  const InertialAxis model{epochs, noise};
  const auto n = static_cast<int>(epochs.size());
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  Eigen::VectorXd m = Eigen::VectorXd::Zero(3 * n);
  const Gaussian<3> prior = inertial_start(start).x;
  P.topLeftCorner<3, 3>() = prior.cov;
  m.head<3>() = prior.mean;
  for (int k = 1; k < n; ++k) {
    const auto step = model.transition(m.segment<3>(3 * (k - 1)), static_cast<std::size_t>(k));
    m.segment<3>(3 * k) = step.mean;
    P.block(3 * k, 0, 3, 3 * k) = step.F * P.block(3 * (k - 1), 0, 3, 3 * k);
    P.block(0, 3 * k, 3 * k, 3) = P.block(3 * k, 0, 3, 3 * k).transpose();
    P.block<3, 3>(3 * k, 3 * k) =
        step.F * P.block<3, 3>(3 * (k - 1), 3 * (k - 1)) * step.F.transpose() + step.Q;
  }
  std::vector<std::pair<Eigen::VectorXd, std::array<double, 2>>> rows;
  for (int k = 0; k < n; ++k) {
    Readings<3, 3> readings;
    model.measure(Mat<3>::Zero(), static_cast<std::size_t>(k), readings);
    for (int i = 0; i < readings.count; ++i) {
      const auto& row = readings.rows[static_cast<std::size_t>(i)];
      Eigen::VectorXd h = Eigen::VectorXd::Zero(3 * n);
      h.segment<3>(3 * k) = row.h;
      rows.push_back({h, {row.value, row.variance}});
    }
  }
  const auto count = static_cast<int>(rows.size());
  Eigen::MatrixXd H(count, 3 * n), R = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd z(count);
  for (int i = 0; i < count; ++i) {
    H.row(i) = rows[static_cast<std::size_t>(i)].first.transpose();
    z(i) = rows[static_cast<std::size_t>(i)].second[0];
    R(i, i) = rows[static_cast<std::size_t>(i)].second[1];
  }
  const Eigen::MatrixXd S = H * P * H.transpose() + R;
  const Eigen::MatrixXd K = S.ldlt().solve(H * P).transpose();
  const Eigen::VectorXd mean = m + K * (z - H * m);
  const Eigen::MatrixXd cov = P - K * H * P;
  const Smoothed found = smoothed(epochs);
  for (int k = 0; k < n; ++k) {
    const auto& x = found.at[static_cast<std::size_t>(k)];
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(x.mean(i), mean(3 * k + i), 1e-6 * std::sqrt(cov(3 * k + i, 3 * k + i)) + 1e-12);
  }
  const std::vector<std::size_t> at{3, 10, 17, 18, 25, 33, 39};
  const PositionCovariance across = smoothed_positions(model, start, at);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = 0; j < at.size(); ++j) {
      const double expected = cov(3 * static_cast<int>(at[i]), 3 * static_cast<int>(at[j]));
      EXPECT_NEAR(across.at(i, j), expected, 1e-7 * std::abs(expected) + 1e-13)
          << at[i] << ' ' << at[j];
    }
}

TEST(Turns, AreFoundPerMotionAndWigglesAreNone) {
  const std::vector<double> p{0, 0, 0.2, 0.5, 0.48, 0.51, 0.3, 0.0, 0.0, 0.0, 0.3, 0.6, 0.6};
  const auto turns = turning_points(p, {{0, 1}, {8, 9}, {11, 12}}, 0.1);
  ASSERT_EQ(turns.size(), 2U);
  EXPECT_EQ(turns[0], (std::vector<std::size_t>{1, 5, 7}));
  EXPECT_EQ(turns[1], (std::vector<std::size_t>{9, 11}));
}

TEST(Turns, AnOddLegOutIsTheOneThatFitsNoOther) {
  const std::vector<double> first_alone{0.9, -0.5, 0.5, -0.4, 0.4};
  auto pairs = pair_legs(first_alone);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_FALSE(pairs[0].back);
  EXPECT_EQ(pairs[1].out, 1U);
  const std::vector<double> last_alone{0.5, -0.5, 0.4, -0.4, 0.9};
  pairs = pair_legs(last_alone);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_TRUE(pairs[0].back);
  EXPECT_FALSE(pairs[2].back);
}

}  // namespace
}  // namespace proofmass::estimate::inertial_axis_test
