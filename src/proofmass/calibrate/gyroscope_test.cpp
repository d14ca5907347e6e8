#include "proofmass/calibrate/gyroscope.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/gyroscope/motion.hpp"
#include "proofmass/calibrate/gyroscope_budget.hpp"
#include "proofmass/calibrate/gyroscope_test_support.hpp"
#include "proofmass/core/so3.hpp"

namespace proofmass::calibrate::gyroscope_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

GyroscopeCalibration calibrated(test::SimulatedRecording& recording,
                                const GyroscopeOptions& options = {.latitude_rad = 0.0}) {
  const MultiPosition accelerometer = test::accelerometer_of(recording.session);
  return calibrate_gyroscope({&recording.session, 1}, accelerometer, options).value();
}

// Coning, φ = θ (cos Ωt, sin Ωt, 0): the rate of its z axis has the closed form (cos θ − 1) Ω.
TEST(MotionIntegral, OfConingIsExactToTheFourthOrder) {
  const double theta = 0.1, omega = 20.0;
  const auto attitude = [&](double t) {
    return rotation_by(theta * Vector3d(std::cos(omega * t), std::sin(omega * t), 0.0));
  };
  const auto error = [&](double dt) {
    MotionSamples motion;
    const auto steps = static_cast<std::size_t>(std::lround(1.0 / dt));
    for (std::size_t n = 0; n <= steps; ++n) {
      const double t = static_cast<double>(n) * dt, h = 1e-4;
      // The rate by a difference of attitudes, of fourth order in h.
      const auto slope = [&](double e) -> Vector3d {
        return rotation_vector(attitude(t - e).transpose() * attitude(t + e)) / (2.0 * e);
      };
      motion.reading.push_back((4.0 * slope(h) - slope(2.0 * h)) / 3.0);
      motion.force.push_back(Vector3d::Zero());
      if (n > 0) motion.step_s.push_back(dt);
    }
    const Matrix3d R =
        integrate(motion, Matrix3d::Identity(), Matrix3d::Zero(), Vector3d::Zero()).R;
    return rotation_vector(R.transpose() * attitude(0.0).transpose() * attitude(1.0)).norm();
  };
  const double coarse = error(0.01), fine = error(0.005);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(fine, coarse / 3.5);
}

TEST(MotionIntegral, HasTheDerivativesOfDifferences) {
  std::mt19937_64 random(7);
  MotionSamples motion;
  for (int n = 0; n < 200; ++n) {
    motion.reading.push_back(test::hand_rate(n / 199.0, 2.0, {0.5, 1.2, -0.7}, {0.1, 0.2, 0.3}));
    motion.force.push_back(3.0 * test::drawn_vector(random));
    if (n > 0) motion.step_s.push_back(0.01);
  }
  const Matrix3d A = Matrix3d::Identity() + 0.01 * Matrix3d::Random(),
                 G = 1e-3 * Matrix3d::Random();
  const MotionRotation at = integrate(motion, A, G, Vector3d::Zero());
  const double h = 1e-5;
  for (Eigen::Index k = 0; k < 9; ++k) {
    Matrix3d moved = A, moved_g = G;
    moved(k / 3, k % 3) += h;
    moved_g(k / 3, k % 3) += 0.1 * h;
    const auto slope = [&](const MotionRotation& next, double step) -> Vector3d {
      return rotation_vector(at.R.transpose() * next.R) / step;
    };
    EXPECT_LT(
        (slope(integrate(motion, moved, G, Vector3d::Zero()), h) - at.by_matrix.col(k)).norm(),
        2e-4);
    EXPECT_LT(
        (slope(integrate(motion, A, moved_g, Vector3d::Zero()), 0.1 * h) - at.by_g.col(k)).norm(),
        2e-3);
  }
}

TEST(GyroscopeCalibration, FindsTheParametersOfASensorWithoutNoise) {
  std::mt19937_64 random(1);
  test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  truth.sample_std = 1e-9;
  test::SimulatedRecording recording =
      test::simulate(truth, {.rate_hz = 200.0, .accel_std_mps2 = 1e-8}, random);
  const GyroscopeCalibration fit = calibrated(recording);
  EXPECT_TRUE(fit.converged);
  EXPECT_LT((fit.estimate - truth.p).head<3>().norm(), 1e-8);
  EXPECT_LT((fit.estimate - truth.p).segment<9>(3).norm(), 1e-5);
  EXPECT_LT((fit.estimate - truth.p).tail<9>().norm(), 1e-9);
}

TEST(GyroscopeCalibration, IsWithinItsUncertaintyAndExplainsTheResidualsByNoise) {
  std::mt19937_64 random(2);
  const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  test::SimulatedRecording recording = test::simulate(truth, {}, random);
  const GyroscopeCalibration fit = calibrated(recording);
  for (Eigen::Index k = 0; k < 21; ++k)
    EXPECT_LT(std::abs(fit.estimate(k) - truth.p(k)), 4.0 * std::sqrt(fit.covariance(k, k))) << k;
  ASSERT_TRUE(fit.lack_of_fit);
  EXPECT_GT(fit.lack_of_fit->p, 0.001);
  EXPECT_EQ(fit.motions.size(), 19U);
  // White noise of 1e-3 a sample at 100 Hz is 1e-4 rad/√s.
  for (const double n : fit.angle_random_walk) EXPECT_NEAR(n, 1e-4, 1e-5);
}

// As printed with two decimals: in all rests the bias is rounded by nearly the same amount.
TEST(GyroscopeCalibration, CountsARoundingThatAllRestsHaveInCommon) {
  for (std::mt19937_64::result_type seed = 1; seed <= 8; ++seed) {
    std::mt19937_64 random(seed);
    const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
    test::SimulatedRecording recording = test::simulate(truth, {}, random);
    constexpr double step_radps = 0.01;
    recording.session.rate_lsb.fill(step_radps);
    for (auto& axis : recording.session.rate)
      for (double& rate : axis) rate = step_radps * std::round(rate / step_radps);
    const GyroscopeCalibration fit = calibrated(recording);
    for (Eigen::Index k = 0; k < 21; ++k)
      EXPECT_LT(std::abs(fit.estimate(k) - truth.p(k)), 3.5 * std::sqrt(fit.covariance(k, k)))
          << seed << ", " << k;
  }
}

TEST(GyroscopeCalibration, LeavesOutMotionsWithoutAllRates) {
  std::mt19937_64 random(4);
  const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  test::SimulatedRecording recording = test::simulate(truth, {.rests = 40}, random);
  for (auto& axis : recording.session.rate)
    for (double& rate : axis)
      if (std::abs(rate) > 1.0) rate = std::numeric_limits<double>::quiet_NaN();
  const GyroscopeCalibration fit = calibrated(recording);
  const auto saturated =
      std::ranges::count(fit.motions, "samples are missing, or at the limit of the range",
                         &MotionResidual::why_unused);
  EXPECT_GT(saturated, 5);
  EXPECT_LT(saturated, 30);
  for (Eigen::Index k = 3; k < 12; ++k)
    EXPECT_LT(std::abs(fit.estimate(k) - truth.p(k)), 3.5 * std::sqrt(fit.covariance(k, k))) << k;
}

TEST(GyroscopeCalibration, SearchesTheScaleOfCountsAndTheAssignmentOfAxes) {
  std::mt19937_64 random(3);
  test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  truth.p.head<3>() = Vector3d(32768.0, 32700.0, 32800.0);
  truth.p.segment<3>(3) *= 6258.0;
  truth.p.tail<9>() *= 6258.0;
  truth.sample_std = 6.0;
  test::SimulatedRecording recording = test::simulate(truth, {}, random);
  const MultiPosition accelerometer = test::accelerometer_of(recording.session);
  const GyroscopeOptions counts{.in_radps = false, .latitude_rad = 0.0};
  const auto fit = calibrate_gyroscope({&recording.session, 1}, accelerometer, counts).value();
  EXPECT_LT((fit.estimate - truth.p).segment<3>(3).norm() / 6258.0, 0.01);
  // Two channels exchanged are a mirror image; with a sign they are a rotation by 90°.
  std::swap(recording.session.rate[0], recording.session.rate[1]);
  const auto mirrored = calibrate_gyroscope({&recording.session, 1}, accelerometer, counts);
  ASSERT_FALSE(mirrored);
  EXPECT_NE(mirrored.error().message.find("left-handed"), std::string::npos);
  for (double& value : recording.session.rate[0]) value = -value;
  const auto turned = calibrate_gyroscope({&recording.session, 1}, accelerometer, counts).value();
  EXPECT_NEAR(turned.estimate.segment<3>(9).norm(), std::numbers::pi / 2.0, 0.06);
}

TEST(GyroscopeCalibration, ExcludesAMotionThatContradictsTheOthers) {
  std::mt19937_64 random(4);
  const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  test::SimulatedRecording recording = test::simulate(truth, {}, random);
  // Saturation: half of the fastest part of motion 7 is lost.
  GyroscopeSession& session = recording.session;
  const std::size_t middle = (session.rests[7].last + session.rests[8].first) / 2;
  for (std::size_t n = middle - 10; n < middle + 10; ++n)
    for (auto& axis : session.rate) axis[n] *= 0.5;
  const GyroscopeCalibration fit = calibrated(recording);
  for (std::size_t k = 0; k < fit.motions.size(); ++k) EXPECT_EQ(fit.motions[k].used, k != 7) << k;
  for (Eigen::Index k = 3; k < 12; ++k)
    EXPECT_LT(std::abs(fit.estimate(k) - truth.p(k)), 4.0 * std::sqrt(fit.covariance(k, k))) << k;
}

TEST(GyroscopeCalibration, LeavesOutAMotionWithMissingSamples) {
  std::mt19937_64 random(5);
  test::SimulatedRecording recording = test::simulate(test::drawn_gyroscope(random), {}, random);
  GyroscopeSession& session = recording.session;
  for (const std::size_t n : {50U, 51U, 52U})
    session.rate[1][session.rests[3].last + n] = std::nan("");
  const GyroscopeCalibration fit = calibrated(recording);
  EXPECT_FALSE(fit.motions[3].used);
  EXPECT_EQ(fit.motions[3].why_unused, "samples are missing, or at the limit of the range");
}

TEST(GyroscopeCalibration, InterpolatesSingleMissingSamples) {
  std::mt19937_64 random(5);
  const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  test::SimulatedRecording recording = test::simulate(truth, {}, random);
  std::size_t k = 0;
  for (auto* sensor : {&recording.session.rate, &recording.session.accel})
    for (auto& axis : *sensor)
      for (std::size_t n = 7 * ++k; n < axis.size(); n += 197) axis[n] = std::nan("");
  const GyroscopeCalibration fit = calibrated(recording);
  for (const MotionResidual& motion : fit.motions) EXPECT_TRUE(motion.used) << motion.why_unused;
  for (Eigen::Index i = 0; i < 12; ++i)
    EXPECT_LT(std::abs(fit.estimate(i) - truth.p(i)), 3.5 * std::sqrt(fit.covariance(i, i))) << i;
}

// Turns about the sensor's x axis alone say nothing of the y and z columns.
TEST(GyroscopeCalibration, SaysWhichParametersTheMotionsDoNotDetermine) {
  std::mt19937_64 random(6);
  const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  test::SimulatedRecording recording =
      test::simulate(truth, {.axes = {Vector3d::UnitX(), -Vector3d::UnitX()}}, random);
  const MultiPosition accelerometer = test::exact_accelerometer(recording);
  const auto fit = calibrate_gyroscope({&recording.session, 1}, accelerometer).value();
  ASSERT_TRUE(fit.parameter(3));
  EXPECT_NEAR(fit.parameter(3)->value, truth.p(3), 4.0 * fit.parameter(3)->std);
  EXPECT_FALSE(fit.parameter(4));
  EXPECT_FALSE(fit.parameter(5));
  EXPECT_NE(fit.why_absent[4].find("axis y, z"), std::string::npos) << fit.why_absent[4];
}

// On a turntable at ±2 rad/s in nine orientations, without motions that show gravity turning.
TEST(GyroscopeCalibration, TakesTheRatesOfATurntable) {
  std::mt19937_64 random(8);
  const test::GyroscopeTruth truth = test::drawn_gyroscope(random);
  test::SimulatedRecording recording = test::simulate(truth, {}, random);
  GyroscopeSession& session = recording.session;
  const MultiPosition accelerometer = test::accelerometer_of(session);
  const auto without =
      calibrate_gyroscope({&session, 1}, accelerometer, {.latitude_rad = 0.0}).value();
  GyroscopeOptions options{.latitude_rad = 0.0};
  std::normal_distribution<double> normal;
  for (int k = 0; k < 12; ++k) {
    const double start_s = session.time_s.back() + 0.01;
    const Vector3d axis = test::drawn_direction(random);
    const Vector3d up = test::g * test::drawn_direction(random);
    for (int n = 0; n < 500; ++n) {
      const Vector3d rate = truth.reading(2.0 * axis, up),
                     accel = test::reading(recording.accel, up);
      session.time_s.push_back(session.time_s.back() + 0.01);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        session.rate[i].push_back(rate(at) + truth.sample_std * normal(random));
        session.accel[i].push_back(accel(at) + 0.005 * normal(random));
      }
    }
    options.table.push_back({.session = 0,
                             .start_s = start_s,
                             .end_s = session.time_s.back(),
                             .rate_radps = k % 2 == 0 ? 2.0 : -2.0,
                             .std_radps = 2e-5});
  }
  const auto with = calibrate_gyroscope({&session, 1}, accelerometer, options).value();
  ASSERT_EQ(with.rates.size(), 12U);
  for (std::size_t k = 3; k < 6; ++k) {
    ASSERT_TRUE(with.parameter(k));
    const auto at = static_cast<Eigen::Index>(k);
    EXPECT_NEAR(with.parameter(k)->value, truth.p(at), 4.0 * with.parameter(k)->std);
    EXPECT_LT(with.parameter(k)->std, 0.7 * without.parameter(k)->std);
  }
}

TEST(GyroscopeCalibration, HasABudgetWhoseLinesMakeTheUncertainty) {
  std::mt19937_64 random(9);
  test::SimulatedRecording recording = test::simulate(test::drawn_gyroscope(random), {}, random);
  const GyroscopeCalibration fit = calibrated(recording, {});
  const std::vector<UncertaintyBudget> budgets = budget_of(fit, "rad/s");
  ASSERT_EQ(budgets.size(), 21U);
  for (std::size_t k = 0; k < 21; ++k) {
    double squares = 0.0;
    for (const BudgetLine& line : budgets[k].lines)
      squares += line.contribution() * line.contribution();
    EXPECT_NEAR(std::sqrt(squares), fit.parameter(k)->std, 1e-4 * fit.parameter(k)->std) << k;
    EXPECT_GT(budgets[k].expanded_95, 1.9 * fit.parameter(k)->std);
  }
  EXPECT_EQ(budgets[12].measurand.unit, "rad/s/(m/s^2)");
}

TEST(GyroscopeCalibration, NeedsThreeMotions) {
  std::mt19937_64 random(10);
  test::SimulatedRecording recording =
      test::simulate(test::drawn_gyroscope(random), {.rests = 3}, random);
  const MultiPosition accelerometer = test::exact_accelerometer(recording);
  const auto fit = calibrate_gyroscope({&recording.session, 1}, accelerometer);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, Errc::too_few_samples);
}

}  // namespace
}  // namespace proofmass::calibrate::gyroscope_test
