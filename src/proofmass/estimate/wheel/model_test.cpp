#include "proofmass/estimate/wheel/model.hpp"

#include <complex>
#include <gtest/gtest.h>

#include "proofmass/estimate/wheel/fit.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_model_test {
namespace {

using test::Mount;
using test::Normal;
using test::Turning;

template <int S>
using State = Mat<wheel::states(S)>;

/// Index of a sensor's lever arm (u component) in the state.
int place_of(int sensors, int s) {
  return wheel::places(sensors) + 2 * s;
}

/// A model with one epoch that has measurements of every sensor.
template <int S>
struct OneEpoch {
  std::vector<WheelEpoch> epochs{WheelEpoch{0.01, {0, S == 2 ? 0 : WheelEpoch::no_row}}};
  std::array<PlanarReadings, 2> readings;
  WheelModel<S> model;

  OneEpoch(double rolling_radius_m, double phase_rad) {
    for (std::size_t s = 0; s < S; ++s) {
      readings[s] = {{1.0}, {2.0}, {0.25}};
      model.readings[s] = &readings[s];
    }
    model.gravity_mps2 = 9.8;
    model.rolling_radius_m = rolling_radius_m;
    model.phase_rad = phase_rad;
    model.epochs = &epochs;
  }

  [[nodiscard]] Readings<WheelModel<S>::states, WheelModel<S>::channels> at(
      const State<S>& x) const {
    Readings<WheelModel<S>::states, WheelModel<S>::channels> out;
    model.measure(x, 0, out);
    return out;
  }
};

/// A state without zeros: any angle, up to ± 40 rad/s, lever arms up to 0.3 m.
template <int S>
State<S> any_state(Normal& normal) {
  State<S> x;
  x.setZero();
  x(wheel::angle) = 20.0 * (normal.uniform() - 0.5);
  x(wheel::speed) = 80.0 * (normal.uniform() - 0.5);
  x(wheel::accel) = 60.0 * (normal.uniform() - 0.5);
  x(wheel::start) = normal();
  for (int s = 0; s < S; ++s) {
    const int at = wheel::first_of(s);
    for (int i = 0; i < 2; ++i) {
      x(at + wheel::bias + i) = normal();
      x(place_of(S, s) + i) = 0.6 * (normal.uniform() - 0.5);
      x(at + wheel::scale + i) = 0.1 * normal();
    }
    x(at + wheel::skew) = 0.1 * normal();
    if (s > 0) x(wheel::phase) = normal();
  }
  return x;
}

template <int S>
void expect_jacobian_of_differences(const OneEpoch<S>& epoch, int readings) {
  Normal normal(17);
  for (int trial = 0; trial < 50; ++trial) {
    auto x = any_state<S>(normal);
    if (epoch.model.with_ripple)
      for (int i = wheel::ripple(S); i < wheel::places(S); ++i) x(i) = 0.02 * normal();
    const auto here = epoch.at(x);
    ASSERT_EQ(here.count, readings);
    for (int j = 0; j < WheelModel<S>::states; ++j) {
      const double h = 1e-5;
      auto up = x, down = x;
      up(j) += h;
      down(j) -= h;
      const auto above = epoch.at(up), below = epoch.at(down);
      for (std::size_t i = 0; i < static_cast<std::size_t>(readings); ++i) {
        const double slope = (above.rows[i].predicted - below.rows[i].predicted) / (2.0 * h);
        EXPECT_NEAR(here.rows[i].h(j), slope, 1e-5 * (1.0 + std::abs(slope)))
            << "reading " << i << ", state " << j;
      }
    }
  }
}

TEST(WheelModel, JacobianOfOneSensorEqualsDifferences) {
  expect_jacobian_of_differences(OneEpoch<1>(0.0, 0.7), 2);
}
TEST(WheelModel, JacobianOfTwoSensorsEqualsDifferences) {
  expect_jacobian_of_differences(OneEpoch<2>(0.0, 0.7), 4);
}
TEST(WheelModel, JacobianOnARollingWheelEqualsDifferences) {
  expect_jacobian_of_differences(OneEpoch<2>(0.3, 0.7), 4);
}
TEST(WheelModel, JacobianWithRippleDelayAndGyroscopesEqualsDifferences) {
  OneEpoch<2> epoch(0.3, 0.7);
  epoch.model.with_ripple = epoch.model.with_gyro = true;
  epoch.model.orders = {1, 2, 5, 7};
  epoch.model.delay_s = 0.01;
  for (PlanarReadings& sensor : epoch.readings) {
    sensor.speed_radps = {1.0};
    sensor.rate_u_radps = {0.7};
    sensor.rate_v_radps = {-1.3};
  }
  expect_jacobian_of_differences(epoch, 6);
}

TEST(WheelModel, JacobianOfAveragesEqualsDifferences) {
  OneEpoch<2> epoch(0.3, 0.7);
  epoch.model.delay_s = 0.01;
  epoch.epochs[0].spread_s2 = 1e-4;
  expect_jacobian_of_differences(epoch, 4);
}

TEST(WheelModel, JacobianWithAnEncoderEqualsDifferences) {
  const EncoderReadings encoder{
      .angle_rad = {3.3}, .age_s = {0.004}, .variance_rad2 = {1e-6}, .direction = -1.0};
  OneEpoch<1> epoch(0.3, 0.0);
  epoch.model.with_ripple = true;
  epoch.model.delay_s = 0.01;
  epoch.model.encoder = &encoder;
  expect_jacobian_of_differences(epoch, 3);
}

// The rippling speed integrated numerically from the initial angle.
TEST(WheelModel, SpeedAndAccelerationAreTheDerivativesOfTheRipplingAngle) {
  WheelModel<1> model;
  model.with_ripple = true;
  model.orders = {1, 2, 3, 7};
  State<1> x = State<1>::Zero();
  for (int i = 0; i < 2 * wheel::ripple_orders; ++i) x(wheel::ripple(1) + i) = 0.01 * (i - 3);
  x(wheel::angle) = 0.8;
  x(wheel::speed) = 6.0;
  x(wheel::accel) = 2.0;
  const auto after = [&](double t) {
    State<1> then = x;
    then(wheel::angle) += 6.0 * t + t * t;
    then(wheel::speed) += 2.0 * t;
    return model.motion(then);
  };
  const double h = 1e-5;
  const auto before = after(-h), now = after(0.0), then = after(h);
  EXPECT_NEAR((then.angle - before.angle) / (2.0 * h), now.speed, 1e-6);
  EXPECT_NEAR((then.speed - before.speed) / (2.0 * h), now.accel, 1e-5);
}

// Response of one pole to a rotating vector: delayed by atan(ω τ), attenuated by its cosine.
TEST(WheelModel, AFilterReadsGravityLaterAndWeaker) {
  OneEpoch<1> epoch(0.0, 0.0);
  epoch.model.delay_s = 0.02;
  State<1> x = State<1>::Zero();
  x(wheel::angle) = 1.1;
  x(wheel::speed) = 30.0;
  const std::complex<double> pole(1.0, 30.0 * 0.02);
  const std::complex<double> read = std::polar(9.8, 1.1) / pole;
  const auto& rows = epoch.at(x).rows;
  EXPECT_NEAR(rows[0].predicted, read.imag(), 1e-12);
  EXPECT_NEAR(rows[1].predicted, read.real(), 1e-12);
}

// Five measurements at irregular times, a fifth of a radian apart, against the model of their mean.
TEST(WheelModel, PredictsTheMeanOfMeasurementsOnATurningWheel) {
  constexpr std::array times_s{0.0, 0.008, 0.009, 0.02, 0.031};
  constexpr double speed_radps = 6.4, radius_m = 0.1;
  WheelReadings readings;
  readings.gravity_mps2 = 9.8;
  PlanarReadings& sensor = readings.sensors.emplace_back();
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double angle = 0.9 + speed_radps * times_s[k];
    readings.time_s.push_back(times_s[k]);
    readings.epochs.push_back({k == 0 ? 0.0 : times_s[k] - times_s[k - 1],
                               {static_cast<std::int64_t>(k), WheelEpoch::no_row}});
    sensor.u_mps2.push_back(9.8 * std::sin(angle) - square(speed_radps) * radius_m);
    sensor.v_mps2.push_back(9.8 * std::cos(angle));
    sensor.variance_m2ps4.push_back(1.0);
  }
  const WheelReadings mean = averaged(readings, times_s.size());
  ASSERT_EQ(mean.epochs.size(), 1U);
  OneEpoch<1> epoch(0.0, 0.0);
  epoch.epochs = mean.epochs;
  State<1> x = State<1>::Zero();
  x(wheel::angle) = 0.9 + speed_radps * mean.time_s[0];
  x(wheel::speed) = speed_radps;
  x(place_of(1, 0)) = radius_m;
  const auto& rows = epoch.at(x).rows;
  // The mean of a third power of the times remains: (ω t)³ g / 6.
  EXPECT_NEAR(rows[0].predicted, mean.sensors[0].u_mps2[0], 2e-4);
  EXPECT_NEAR(rows[1].predicted, mean.sensors[0].v_mps2[0], 2e-4);
  epoch.epochs[0].spread_s2 = 0.0;
  EXPECT_GT(std::abs(epoch.at(x).rows[0].predicted - mean.sensors[0].u_mps2[0]), 0.01);
}

// The same force by differentiating the position of a point in the complex plane twice
// (wheel_test_support.hpp).
TEST(WheelModel, PredictsExactlyWhatTheKinematicsOfAPointSay) {
  Normal normal(3);
  for (const double rolling_radius_m : {0.0, 0.31}) {
    const OneEpoch<2> epoch(rolling_radius_m, 0.4);
    for (int trial = 0; trial < 50; ++trial) {
      const auto x = any_state<2>(normal);
      const auto out = epoch.at(x);
      const Turning now{x(wheel::angle), x(wheel::speed), x(wheel::accel)};
      const test::Site site{9.8, 0.0, rolling_radius_m};
      for (int s = 0; s < 2; ++s) {
        const int at = wheel::first_of(s);
        Mount mount;
        mount.turned_rad = s == 0 ? 0.0 : 0.4 + x(wheel::phase);
        // The model has the lever arm in the sensor's own axes, the mount in the wheel's.
        mount.place_m = std::complex(x(place_of(2, s)), x(place_of(2, s) + 1)) *
                        std::polar(1.0, mount.turned_rad);
        mount.bias_mps2 = {x(at + wheel::bias), x(at + wheel::bias + 1)};
        mount.scale = {1.0 + x(at + wheel::scale), 1.0 + x(at + wheel::scale + 1)};
        mount.skew_rad = x(at + wheel::skew);
        const auto expected = test::reading(test::force(now, mount, site), mount);
        const auto row = 2 * static_cast<std::size_t>(s);
        EXPECT_NEAR(out.rows[row].predicted, expected[0], 1e-11);
        EXPECT_NEAR(out.rows[row + 1].predicted, expected[1], 1e-11);
      }
    }
  }
}

// Lele (2010), section 4.4: sensors at ±R with parallel axes; half the sum is gravity, half the
// difference −R ω² and R α.
TEST(WheelModel, OfAnOppositePairSumIsGravityAndDifferenceIsTheMotion) {
  constexpr double R = 0.1;
  const OneEpoch<2> epoch(0.0, 0.0);
  State<2> x;
  x.setZero();
  x(wheel::angle) = 0.6;
  x(wheel::speed) = 3.0;
  x(wheel::accel) = -5.0;
  x(place_of(2, 0)) = R;
  x(place_of(2, 1)) = -R;
  const auto& rows = epoch.at(x).rows;
  EXPECT_NEAR(0.5 * (rows[0].predicted + rows[2].predicted), 9.8 * std::sin(0.6), 1e-14);
  EXPECT_NEAR(0.5 * (rows[1].predicted + rows[3].predicted), 9.8 * std::cos(0.6), 1e-14);
  EXPECT_NEAR(0.5 * (rows[0].predicted - rows[2].predicted), -R * 9.0, 1e-14);
  EXPECT_NEAR(0.5 * (rows[1].predicted - rows[3].predicted), R * -5.0, 1e-14);
}

TEST(WheelModel, TakesValuesAndVariancesFromTheRowsOfTheEpoch) {
  OneEpoch<2> epoch(0.0, 0.0);
  epoch.readings[1] = {{0.0, 5.0}, {0.0, 6.0}, {9.0, 0.5}};
  epoch.epochs[0].row = {0, 1};
  const auto out = epoch.at(State<2>::Zero());
  const std::array values{1.0, 2.0, 5.0, 6.0}, variances{0.25, 0.25, 0.5, 0.5};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(out.rows[i].value, values[i]);
    EXPECT_EQ(out.rows[i].variance, variances[i]);
  }
}

TEST(WheelModel, ASensorThatWasNotReadGivesNoReadings) {
  OneEpoch<2> epoch(0.0, 0.0);
  epoch.epochs[0].row[0] = WheelEpoch::no_row;
  const auto second_only = epoch.at(State<2>::Zero());
  EXPECT_EQ(second_only.count, 2);
  EXPECT_EQ(second_only.rows[0].h(wheel::first_of(1) + wheel::bias), 1.0);
  epoch.readings[1].v_mps2[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(epoch.at(State<2>::Zero()).count, 0);
}

TEST(WheelModel, TwoStepsEqualOneOfTwiceTheLength) {
  std::vector<WheelEpoch> epochs{{0.0, {}}, {0.013, {}}, {0.026, {}}};
  WheelModel<2> model;
  model.epochs = &epochs;
  model.noise = {.jerk_psd = 3.0, .snap_psd = 7.0, .bias_walk_psd = 1e-5};
  State<2> x = State<2>::Zero();
  x.head<wheel::moving>() << 0.5, -1.2, 3.0, 0.7;
  const auto one = model.transition(x, 1), two = model.transition(x, 2);
  EXPECT_TRUE(two.F.isApprox(one.F * one.F, 1e-14));
  EXPECT_TRUE(two.Q.isApprox(one.F * one.Q * one.F.transpose() + one.Q, 1e-14));
  EXPECT_TRUE(two.walk.isApprox(2.0 * one.walk, 1e-14));
  EXPECT_TRUE(two.mean.isApprox(two.F * x.head<wheel::moving>(), 1e-14));
}

TEST(WheelModel, EachOfTheTwoDrivesIsThatOfItsOwnModel) {
  std::vector<WheelEpoch> epochs{{0.0, {}}, {0.1, {}}};
  WheelModel<1> model;
  model.epochs = &epochs;
  model.noise = {.jerk_psd = 3.0, .snap_psd = 0.0};
  const auto rough = model.transition(State<1>::Zero(), 1);
  EXPECT_DOUBLE_EQ(rough.Q(wheel::accel, wheel::accel), 3.0 * 0.1);
  EXPECT_EQ(rough.Q(wheel::jerk, wheel::jerk), 0.0);
  model.noise = {.jerk_psd = 0.0, .snap_psd = 3.0};
  const auto smooth_drive = model.transition(State<1>::Zero(), 1);
  EXPECT_DOUBLE_EQ(smooth_drive.Q(wheel::jerk, wheel::jerk), 3.0 * 0.1);
  EXPECT_DOUBLE_EQ(smooth_drive.Q(wheel::accel, wheel::accel), 3.0 * 0.001 / 3.0);
}

TEST(WheelModel, OnlyTheBiasesWalk) {
  std::vector<WheelEpoch> epochs{{0.0, {}}, {0.01, {}}};
  WheelModel<2> model;
  model.epochs = &epochs;
  model.noise = {.jerk_psd = 1.0, .snap_psd = 2.0, .bias_walk_psd = 0.5};
  const auto step = model.transition(State<2>::Zero(), 1);
  for (int i = wheel::moving; i < wheel::states(2); ++i) {
    const int one = i - wheel::first_of(0), two = i - wheel::first_of(1);
    const bool is_bias = one == 0 || one == 1 || two == 0 || two == 1;
    EXPECT_DOUBLE_EQ(step.walk(i), is_bias ? 0.005 : 0.0) << "state " << i;
  }
}

// About a given path the measurements are exactly linear in the constants, and their gradient is
// independent of the filter's state.
TEST(WheelModel, AboutAPathTheConstantsEnterLinearly) {
  Normal normal(5);
  OneEpoch<1> epoch(0.0, 0.0);
  const State<1> x = any_state<1>(normal);
  WheelPath path;
  path.moving.push_back(x.head<wheel::moving>());
  path.standing = x.tail<wheel::standing(1)>();
  const auto exact = epoch.at(x);
  epoch.model.about = &path;
  const auto at_path = epoch.at(x);
  EXPECT_NEAR(at_path.rows[0].predicted, exact.rows[0].predicted, 1e-12);
  State<1> moved = x;
  moved(wheel::first_of(0) + wheel::scale) += 0.1;
  moved(wheel::first_of(0) + wheel::skew) += 0.1;
  const auto beside = epoch.at(moved);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(beside.rows[i].h, at_path.rows[i].h);
    EXPECT_NEAR(beside.rows[i].predicted,
                at_path.rows[i].predicted + at_path.rows[i].h.dot(moved - x), 1e-12);
  }
}

// A ripple that differs from the path's by 0.02 rad turns the wheel by that much, of which the
// second order, g δ²/2, is 2 mm/s².
TEST(WheelModel, AboutAPathARippleKeepsThePredictedAngle) {
  Normal normal(7);
  OneEpoch<1> epoch(0.0, 0.0);
  epoch.model.with_ripple = true;
  State<1> x = any_state<1>(normal);
  x.tail<2>().setZero();  // the lever arm
  WheelPath path;
  path.moving.push_back(x.head<wheel::moving>());
  path.standing = x.tail<wheel::standing(1)>();
  x(wheel::ripple(1)) += 0.02;
  x(wheel::ripple(1) + 1) -= 0.02;
  const auto exact = epoch.at(x);
  epoch.model.about = &path;
  const auto about = epoch.at(x);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(about.rows[i].predicted, exact.rows[i].predicted, 1e-4);
}

TEST(WheelModel, FarFromAPathTheMotionEntersLinearly) {
  Normal normal(8);
  OneEpoch<1> epoch(0.0, 0.0);
  State<1> x = any_state<1>(normal);
  WheelPath path;
  path.moving.push_back(x.head<wheel::moving>());
  path.standing = x.tail<wheel::standing(1)>();
  const auto on_path = epoch.at(x);
  const auto predicted = [&](double off_rad, bool about) {
    State<1> off = x;
    off(wheel::angle) += off_rad;
    epoch.model.about = about ? &path : nullptr;
    return epoch.at(off);
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& row = on_path.rows[i];
    EXPECT_NEAR(predicted(0.05, true).rows[i].predicted, predicted(0.05, false).rows[i].predicted,
                1e-12);
    EXPECT_NEAR(predicted(0.3, true).rows[i].predicted, row.predicted + 0.3 * row.h(wheel::angle),
                1e-12);
  }
}

// Measurements through a delay τ equal those of an undelayed wheel τ earlier, except for the
// attenuation of rotating components.
TEST(WheelModel, ADelayShowsTheMotionOfEarlier) {
  Normal normal(6);
  OneEpoch<1> epoch(0.0, 0.0);
  epoch.model.with_ripple = true;
  State<1> x = any_state<1>(normal);
  x(wheel::speed) = 4.0;
  x(wheel::accel) = x(wheel::jerk) = 0.0;
  x.segment<8>(wheel::ripple(1)).setConstant(0.01);
  constexpr double late_s = 1e-3;
  State<1> earlier = x;
  earlier(wheel::angle) -= late_s * x(wheel::speed);
  const auto undelayed = epoch.at(earlier);
  epoch.model.delay_s = late_s;
  const auto delayed = epoch.at(x);
  for (std::size_t i = 0; i < 2; ++i)
    // attenuation g (ω τ)² / 2, without a term proportional to τ
    EXPECT_NEAR(delayed.rows[i].predicted, undelayed.rows[i].predicted, 1.5e-4);
}

// A static wheel constrains the speed, not the angle.
TEST(WheelModel, StandingIsAConstraintOfTheSpeed) {
  OneEpoch<1> epoch(0.0, 0.0);
  State<1> x = State<1>::Zero();
  x(wheel::speed) = 0.2;
  EXPECT_EQ(epoch.at(x).constraints, 0);
  epoch.epochs[0].stands = true;
  const auto out = epoch.at(x);
  ASSERT_EQ(out.count, 3);
  EXPECT_EQ(out.constraints, 1);
  EXPECT_EQ(out.rows[2].value, 0.0);
  EXPECT_EQ(out.rows[2].predicted, 0.2);
  EXPECT_EQ(out.rows[2].h, State<1>::Unit(wheel::speed));
  // 0.01 s of half a second: fifty times the variance.
  EXPECT_NEAR(out.rows[2].variance, 50.0 * square(standing_speed_radps), 1e-12);
}

TEST(WheelModel, ReopeningBeginsAgainFromThePath) {
  WheelModel<1> model;
  WheelPath path;
  path.moving.assign(3, Mat<wheel::moving>(1.0, 2.0, 3.0, 4.0));
  path.standing = Eigen::VectorXd::Zero(wheel::standing(1));
  model.about = &path;
  Gaussian<wheel::states(1)> x;
  x.mean.setConstant(100.0);
  model.reopen(x, 2);
  EXPECT_EQ((x.mean.head<wheel::moving>()), path.moving[2]);
  EXPECT_EQ(x.mean(wheel::start), 100.0);
}

TEST(WheelModel, ReopeningForgetsTheMotionAndKeepsTheConstants) {
  const WheelModel<1> model;
  Gaussian<wheel::states(1)> x;
  x.cov.setConstant(0.1);
  x.cov.diagonal().array() += 1.0;
  const auto before = x.cov;
  model.reopen(x, 0);
  constexpr int moving = wheel::moving, rest = wheel::states(1) - wheel::moving;
  EXPECT_EQ((x.cov.bottomRightCorner<rest, rest>()), (before.bottomRightCorner<rest, rest>()));
  EXPECT_TRUE((x.cov.topRightCorner<moving, rest>().isZero()));
  EXPECT_TRUE((x.cov.bottomLeftCorner<rest, moving>().isZero()));
  EXPECT_EQ(x.cov(moving, moving), 1.1);
  EXPECT_GE(x.cov(wheel::angle, wheel::angle), 1.0);
  EXPECT_EQ(x.cov, x.cov.transpose());
}

}  // namespace
}  // namespace proofmass::estimate::wheel_model_test
