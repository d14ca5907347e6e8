#include "proofmass/estimate/wheel/likelihood.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "proofmass/estimate/wheel/colour.hpp"
#include "proofmass/estimate/wheel/rests.hpp"
#include "proofmass/estimate/wheel/settle.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_passes_test {
namespace {

/// For an AR(1) sequence with unit driving noise, in blocks much longer than its correlation time.
double block_ratio(double coefficient) {
  constexpr int blocks = 400, each = 500;
  test::Normal normal(3);
  BlockVariance variance;
  double value = 0.0;
  for (int block = 0; block < blocks; ++block) {
    for (int i = 0; i < each; ++i) variance.add(value = coefficient * value + normal());
    variance.end_block();
  }
  return variance.ratio();
}

// For an AR(1) sequence the variance of the sum over a long block is (1 + a) / (1 − a) times the
// sum of the variances. One standard deviation of the ratio over 400 blocks is 7 %.
TEST(BlockVariance, IsOneOfWhiteScoresAndTheLongRunVarianceOfColouredOnes) {
  EXPECT_NEAR(block_ratio(0.0), 1.0, 0.25);
  EXPECT_NEAR(block_ratio(0.8), 9.0, 2.3);
}

TEST(BlockVariance, OfCancellingScoresIsNotBelowOne) {
  EXPECT_EQ(block_ratio(-0.8), 1.0);
  EXPECT_EQ(BlockVariance{}.ratio(), 1.0);
}

/// A path with constant acceleration from `from_radps` to `to_radps` within ten seconds, at 100 Hz.
struct Ramp {
  WheelPath path;
  WheelReadings readings;  ///< their times; two rows, for the noise
  double accel_radps2;

  Ramp(double from_radps, double to_radps) : accel_radps2((to_radps - from_radps) / 10.0) {
    for (int k = 0; k <= 1000; ++k) {
      const double t = 0.01 * k;
      readings.time_s.push_back(t);
      path.moving.emplace_back(0.0, from_radps + accel_radps2 * t, accel_radps2, 0.0);
      readings.epochs.push_back({k == 0 ? 0.0 : 0.01, {k, WheelEpoch::no_row}});
    }
    readings.sensors.push_back({.u_mps2 = {}, .v_mps2 = {}, .variance_m2ps4 = {1e-4, 1e-4}});
  }
};

TEST(WheelLevers, OfASteadyWheelAreItsSquaredSpeedAndNoAcceleration) {
  const Ramp steady(20.0, 20.0);
  for (const Mat<2>& lever : levers_of(steady.path, steady.readings)) {
    EXPECT_DOUBLE_EQ(lever(0), 400.0);
    EXPECT_EQ(lever(1), 0.0);
  }
}

// The mean of (ω + α t)² over a window centred at an epoch is ω² + α² h² / 3; one more row on one
// side changes it by ω α times a step.
TEST(WheelLevers, OfARampAreMeansOverTheTurnAboutEachEpoch) {
  const Ramp ramp(10.0, 30.0);
  const WheelLevers levers = levers_of(ramp.path, ramp.readings);
  for (std::size_t k = 0; k < levers.size(); ++k) {
    const double w = ramp.path.moving[k](wheel::speed);
    const double half_s = 0.5 * rad_per_turn / w + 0.01;
    const double bound =
        std::pow(ramp.accel_radps2 * half_s, 2) / 3.0 + w * ramp.accel_radps2 * 0.01;
    EXPECT_NEAR(levers[k](0), w * w, bound);
    EXPECT_NEAR(levers[k](1), ramp.accel_radps2, 1e-9);
  }
}

// A vibrating hub may be a vehicle's: three seconds, whatever the speed.
TEST(WheelLevers, OfAWheelThatShakesAreMeansOverThreeSeconds) {
  Ramp ramp(10.0, 30.0);
  ramp.readings.shakes = true;
  const double t = 5.0, w = 10.0 + ramp.accel_radps2 * t;
  EXPECT_NEAR(levers_of(ramp.path, ramp.readings)[500](0),
              w * w + std::pow(ramp.accel_radps2 * 1.5, 2) / 3.0, 0.1);
}

/// Variance of the sum of scores divided by the sum of their variances, for measurements whose
/// residuals are an AR(1) sequence of unit variance.
double score_ratio(double coefficient) {
  constexpr int count = 40'000;
  constexpr double rate_hz = 100.0, block_s = 2.0;
  test::Normal normal(5);
  ScoreBlocks<1> blocks(block_s);
  Readings<wheel::states(1), WheelModel<1>::channels> readings;
  readings.count = 1;
  auto& row = readings.rows[0];
  row.h.setZero();
  row.h(wheel::first_of(0)) = 2.0;
  row.predicted = 0.0;
  row.variance = 4.0;  // so that Huber's limit is not reached
  double misfit = 0.0;
  for (int k = count; k-- > 0;) {
    misfit = coefficient * misfit + std::sqrt(1.0 - coefficient * coefficient) * normal();
    row.value = misfit;
    blocks.add(k / rate_hz, readings);
  }
  return blocks.covariance()(0, 0) / (count * std::pow(2.0 / 4.0, 2));
}

// 200 blocks: one standard deviation of the ratio is 10 %.
TEST(ScoreBlocks, GiveTheVarianceOfASumOfWhiteAndOfColouredScores) {
  EXPECT_NEAR(score_ratio(0.0), 1.0, 0.35);
  EXPECT_NEAR(score_ratio(0.8), 9.0, 3.0);
}

/// Measurements of a sensor on the axle of a wheel at 1.5 rad/s, at 40 Hz for a minute.
struct SlowWheel {
  static constexpr double rate_hz = 40.0, speed_radps = 1.5, noise_mps2 = 0.01;
  WheelReadings readings;
  WheelPath path;

  explicit SlowWheel(int epochs = 2400) {
    readings.sensors.resize(1);
    test::Normal normal(2);
    PlanarReadings& sensor = readings.sensors[0];
    for (int k = 0; k < epochs; ++k) {
      const double t = k / rate_hz, angle = speed_radps * t;
      readings.time_s.push_back(t);
      readings.epochs.push_back({k == 0 ? 0.0 : 1.0 / rate_hz, {k, WheelEpoch::no_row}});
      sensor.u_mps2.push_back(readings.gravity_mps2 * std::sin(angle) + noise_mps2 * normal());
      sensor.v_mps2.push_back(readings.gravity_mps2 * std::cos(angle) + noise_mps2 * normal());
      sensor.variance_m2ps4.push_back(1.0);
      path.moving.emplace_back(angle, speed_radps, 0.0, 0.0);
    }
    path.standing = Eigen::VectorXd::Zero(wheel::standing(1));
  }
};

// With process noise far above the wheel's, the filter follows every measurement and its
// innovations do not show the measurement noise. The variance must not fall below the true one;
// such an underestimate lost track of a wheel at 14 rpm within an hour.
TEST(SettleVariance, IsNotUnderestimatedUnderLargeProcessNoise) {
  SlowWheel slow;
  const auto model = held_model<1>(slow.readings, {.jerk_psd = 1e4}, slow.path);
  const WheelPrior prior{{0.0, 0.2, SlowWheel::speed_radps, 1.0}, {}, Places::Zero(2)};
  settle_variance(model, prior, slow.readings);
  EXPECT_NEAR(std::sqrt(slow.readings.sensors[0].variance_m2ps4[1200]), SlowWheel::noise_mps2,
              0.2 * SlowWheel::noise_mps2);
}

// No motion of the wheel changes the measurements along gravity, so those show a vibrating hub
// however closely the filter follows.
TEST(SettleVariance, SeesAHubThatShakes) {
  SlowWheel slow;
  const WheelPrior prior{{0.0, 0.2, SlowWheel::speed_radps, 1.0}, {}, Places::Zero(2)};
  const WheelNoise follows_all{.jerk_psd = 1e4};
  settle_variance(held_model<1>(slow.readings, follows_all, slow.path), prior, slow.readings);
  EXPECT_FALSE(slow.readings.shakes);
  test::Normal normal(3);
  constexpr double shaking_mps2 = 0.3;
  PlanarReadings& sensor = slow.readings.sensors[0];
  for (std::size_t k = 1200; k < 2400; ++k) {
    sensor.u_mps2[k] += shaking_mps2 * normal();
    sensor.v_mps2[k] += shaking_mps2 * normal();
  }
  settle_variance(held_model<1>(slow.readings, follows_all, slow.path), prior, slow.readings);
  EXPECT_TRUE(slow.readings.shakes);
  EXPECT_GT(sensor.variance_m2ps4[1800], 0.4 * square(shaking_mps2));
}

// A recording that is long enough is filtered in two halves side by side.
TEST(SettleVariance, FollowsTheNoiseThroughBothHalvesOfALongRecording) {
  constexpr std::size_t epochs = 420'000, louder_from = 300'000;
  SlowWheel slow(epochs);
  PlanarReadings& sensor = slow.readings.sensors[0];
  test::Normal normal(5);
  for (std::size_t k = louder_from; k < epochs; ++k)
    for (std::vector<double>* axis : {&sensor.u_mps2, &sensor.v_mps2})
      (*axis)[k] += 3.0 * SlowWheel::noise_mps2 * normal();
  const WheelPrior prior{{0.0, 0.2, SlowWheel::speed_radps, 1.0}, {}, Places::Zero(2)};
  settle_variance(held_model<1>(slow.readings, {.jerk_psd = 1e-3}, slow.path), prior,
                  slow.readings);
  const auto std_mps2 = [&](std::size_t k) { return std::sqrt(sensor.variance_m2ps4[k]); };
  for (const std::size_t k : {1'000U, 150'000U, 205'000U, 215'000U, 290'000U})
    EXPECT_NEAR(std_mps2(k), SlowWheel::noise_mps2, 0.3 * SlowWheel::noise_mps2) << k;
  for (const std::size_t k : {310'000U, 419'000U})
    EXPECT_NEAR(std_mps2(k), std::sqrt(10.0) * SlowWheel::noise_mps2, SlowWheel::noise_mps2) << k;
}

// With the noise of a long recording's averages known, a filter with the motion noise of the search
// for the track slips, and there the likelihood has a local maximum.
TEST(TuneNoise, LeavesAStartAtWhichTheFilterSlips) {
  SlowWheel slow(20'000);
  for (double& variance : slow.readings.sensors[0].variance_m2ps4)
    variance = square(SlowWheel::noise_mps2);
  const WheelPrior prior{{0.0, 0.2, SlowWheel::speed_radps, 1.0}, {}, Places::Zero(2)};
  for (const std::size_t each : {10, 20, 60}) {
    const WheelReadings averages = averaged(slow.readings, each);
    const WheelPath path{moving_at(averages.time_s, slow.readings.time_s, slow.path.moving),
                         slow.path.standing};
    for (const double jerk_psd : {20.0, 500.0, 2e4}) {
      const auto model = held_model<1>(averages, {.jerk_psd = jerk_psd}, path);
      const TunedNoise tuned = tune_noise(model, excerpt_to_tune(model, prior), false);
      EXPECT_LT(tuned.noise.jerk_psd, 1e-4) << each << " " << jerk_psd;
    }
  }
}

TEST(MovingAt, IsExactWithConstantJerk) {
  const Mat<wheel::moving> start(1.0, 2.0, -3.0, 0.5);
  const std::vector<double> path_s{0.0, 1.0, 2.5};
  std::vector<Mat<wheel::moving>> path;
  for (const double t : path_s) path.emplace_back(constant_jerk(t) * start);
  const std::vector<double> times_s{-0.5, 0.0, 0.7, 2.4, 3.0};
  const auto moving = moving_at(times_s, path_s, path);
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double t = times_s[k];
    EXPECT_NEAR(moving[k](wheel::angle), 1.0 + 2.0 * t - 1.5 * t * t + t * t * t / 12.0, 1e-12);
    EXPECT_NEAR(moving[k](wheel::accel), -3.0 + 0.5 * t, 1e-12);
  }
}

TEST(MovingAt, IsFromTheNearerSideOfAGap) {
  const std::vector<Mat<wheel::moving>> path{{0.0, 1.0, 0.0, 0.0}, {100.0, 5.0, 0.0, 0.0}};
  const auto moving = moving_at({4.0, 6.0}, {0.0, 10.0}, path);
  EXPECT_EQ(moving[0](wheel::angle), 4.0);
  EXPECT_EQ(moving[1](wheel::angle), 80.0);
}

TEST(TurnedAfter, IsATurnFromTheGivenEpoch) {
  WheelPath path;
  for (int k = 0; k < 30; ++k) path.moving.emplace_back(-k, -1.0, 0.0, 0.0);
  EXPECT_EQ(turned_after(path, 0), 7U);
  EXPECT_EQ(turned_after(path, 10), 17U);
  EXPECT_EQ(turned_after(path, 25), 30U);  // never
}

TEST(MarkStanding, IsAWheelWhoseReadingsKeepTheirValues) {
  SlowWheel slow;
  PlanarReadings& sensor = slow.readings.sensors[0];
  test::Normal normal(4);
  for (std::size_t k = 1000; k < 2400; ++k) {
    sensor.u_mps2[k] = 3.0 + SlowWheel::noise_mps2 * normal();
    sensor.v_mps2[k] = 9.0 + SlowWheel::noise_mps2 * normal();
  }
  mark_standing(slow.readings);
  const auto& epochs = slow.readings.epochs;
  EXPECT_TRUE(std::none_of(epochs.begin(), epochs.begin() + 1000,
                           [](const WheelEpoch& epoch) { return epoch.stands; }));
  // 1400 epochs at rest, minus the interval in which the wheel stops and a false-alarm rate of 5 %.
  EXPECT_GE(std::ranges::count(epochs, true, &WheelEpoch::stands), 1260);
}

// At 0.1 rad/s, a turn in a minute, a wheel moves.
TEST(MarkStanding, IgnoresASlowWheel) {
  SlowWheel slow;
  PlanarReadings& sensor = slow.readings.sensors[0];
  test::Normal normal(4);
  for (std::size_t k = 0; k < 2400; ++k) {
    const double angle = 0.1 * static_cast<double>(k) / SlowWheel::rate_hz;
    sensor.u_mps2[k] = 9.8 * std::sin(angle) + SlowWheel::noise_mps2 * normal();
    sensor.v_mps2[k] = 9.8 * std::cos(angle) + SlowWheel::noise_mps2 * normal();
  }
  mark_standing(slow.readings);
  EXPECT_TRUE(std::ranges::none_of(slow.readings.epochs, &WheelEpoch::stands));
}

TEST(WheelReadings, RateIsThatOfRowsWhichArriveInPackets) {
  WheelReadings readings;
  for (int k = 0; k < 2000; ++k)
    // Ten rows every 25 ms, ten microseconds apart; one gap of a minute.
    readings.epochs.push_back({k % 10 > 0 ? 1e-5 : k == 1000 ? 60.0 : 0.025 - 9e-5});
  EXPECT_NEAR(readings.rate_hz(), 400.0, 4.0);
}

/// A wheel at 6 rad/s with a speed ripple of 1 % in one order, about a path without that ripple.
struct RipplingWheel {
  static constexpr double rate_hz = 200.0, speed_radps = 6.0, share = 0.01, radius_m = 0.1;
  WheelReadings readings;
  WheelPath path;

  explicit RipplingWheel(int order) {
    readings.sensors.resize(1);
    test::Normal normal(2);
    PlanarReadings& sensor = readings.sensors[0];
    for (int k = 0; k < 4000; ++k) {
      const double even = speed_radps * k / rate_hz, phase = order * even;
      const double angle = even + share * std::sin(phase) / order;
      const double speed = speed_radps * (1.0 + share * std::cos(phase));
      const double accel = -square(speed_radps) * share * order * std::sin(phase);
      readings.time_s.push_back(k / rate_hz);
      readings.epochs.push_back({k == 0 ? 0.0 : 1.0 / rate_hz, {k, WheelEpoch::no_row}});
      sensor.u_mps2.push_back(readings.gravity_mps2 * std::sin(angle) - square(speed) * radius_m +
                              0.03 * normal());
      sensor.v_mps2.push_back(readings.gravity_mps2 * std::cos(angle) + accel * radius_m +
                              0.03 * normal());
      sensor.variance_m2ps4.push_back(1e-3);
      path.moving.emplace_back(even, speed_radps, 0.0, 0.0);
    }
    path.standing = Eigen::VectorXd::Zero(wheel::standing(1));
    path.standing(wheel::standing(1) - 2) = radius_m;
  }
};

TEST(RippleOrders, AreThoseThatExplainTheReadings) {
  for (const int order : {3, 7, 12}) {
    const RipplingWheel rippling(order);
    EXPECT_EQ(orders_in<1>(rippling.readings, rippling.path)[2], order);
  }
}

TEST(HeldModel, IsLinearAboutThePathForOneTurn) {
  const SlowWheel slow;
  const double turn_s = rad_per_turn / SlowWheel::speed_radps;
  EXPECT_EQ(held_model<1>(slow.readings, {}, slow.path).first_turn,
            static_cast<std::size_t>(std::floor(turn_s * SlowWheel::rate_hz)) + 1);
}

}  // namespace
}  // namespace proofmass::estimate::wheel_passes_test
