#include <Eigen/Core>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/estimate/models/angular_model.hpp"
#include "proofmass/estimate/position_budget.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/sensor/model_equation.hpp"
#include "proofmass/thesis/errata/errata_test_support.hpp"

// docs/errata.md, chapters 1 to 3: the sensor, its errors and the card.
namespace proofmass::thesis::errata_sensor_test {
namespace {

using errata::g, errata::mg;

// 1.1: "Integration of tilt or angular data from gyroscope gives the angular velocity".
TEST(ErrataChapter1, AGyroscopeIntegratedIsAnAngle) {
  const auto model = estimate::tilt_rate_model({.dt_s = 0.01,
                                                .rate_psd_rad2ps = 1e-6,
                                                .bias_psd_rad2ps3 = 1e-10,
                                                .angle_variance_rad2 = 1e-4});
  estimate::Mat<2> state = estimate::Mat<2>::Zero();
  for (int k = 0; k < 200; ++k) state = (model.F * state + model.B * 0.3).eval();
  EXPECT_NEAR(state(0), 0.6, 1e-12);  // 2 s at 0.3 rad/s
}

// 2.4.1: "Bias is defined as the non-zero voltage output when only earth gravity vector, zero g is
// acting".
TEST(ErrataChapter2, UnderGravityAloneASensorWithoutBiasReadsGravity) {
  simulate::RigOptions rig = errata::wheel(0.0, std::numbers::pi / 2.0);
  EXPECT_NEAR(errata::first(rig, "acc1_x"), g, 1e-12);
  EXPECT_NEAR(errata::first(rig, "acc1_y"), 0.0, 1e-12);
  rig.sensors[0].bias_mps2 = {0.2, 0.2, 0.2};
  EXPECT_NEAR(errata::first(rig, "acc1_x"), g + 0.2, 1e-12);
  EXPECT_NEAR(errata::first(rig, "acc1_y"), 0.2, 1e-12);
}

// Table 2.1, "Horizontal position error" after an hour. A levelled navigator on a round Earth obeys
// x'' = b − (g/r) x, integrated here by leapfrog.
TEST(ErrataChapter2, HalfBiasTimesTimeSquaredHoldsForMinutesAndNotForAnHour) {
  constexpr double bias = 1e-3, earth_m = 6.371e6, dt = 0.1;
  double x = 0.0, v = 0.5 * dt * bias, after_a_minute = 0.0;
  for (int k = 1; k <= 36000; ++k) {
    x += dt * v;
    v += dt * (bias - g / earth_m * x);
    if (k == 600) after_a_minute = x;
  }
  const std::vector<estimate::BudgetSensor> sensors{{.name = "s", .bias_mps2 = {bias, 0.0}}};
  const auto rows = estimate::position_budget(sensors, std::array{60.0, 3600.0});
  EXPECT_NEAR(rows[0].errors[0].position_m.value / after_a_minute, 1.0, 1e-3);
  EXPECT_NEAR(rows[0].errors[1].position_m.value / x, 8.0, 0.1);
}

// 2.4.3: "for performance goal of 1 %, initial alignment error must not exceed by 8°". Correct.
TEST(ErrataChapter2, EightDegreesChangeTheScaleByOnePercentAndNotTheBias) {
  const double off = 8.0 * rad_per_deg;
  const auto found = calibrate::four_point({.E0 = g * std::sin(off),
                                            .E90 = g * std::cos(off),
                                            .E180 = -g * std::sin(off),
                                            .E270 = -g * std::cos(off)},
                                           g);
  EXPECT_NEAR(found.K1, 1.0 - 0.0097, 5e-5);
  EXPECT_NEAR(found.bias_0g_mps2, 0.0, 1e-12);
}

// (2.2) with S_y and S_z as the sensitivities of the y and z axes, as they are named.
TEST(ErrataChapter2, CrossAxisSensitivityIsNotMadeOfTheOtherAxesOwnSensitivities) {
  const double S = 0.330 / g;
  Eigen::Matrix3d sensitivity = S * Eigen::Matrix3d::Identity();
  sensitivity(0, 1) = sensitivity(0, 2) = 0.01 * S;
  const Eigen::Matrix<double, 9, 9> covariance =
      1e-14 * S * S * Eigen::Matrix<double, 9, 9>::Identity();
  const auto found = calibrate::cross_axis_sensitivities(sensitivity, covariance).value();
  ASSERT_TRUE(found[0].value);
  EXPECT_NEAR(found[0].value->value, 0.01 * std::numbers::sqrt2, 1e-6);
  EXPECT_FALSE(found[1].value);  // y responds to y only
  EXPECT_NEAR(std::hypot(sensitivity(1, 1), sensitivity(2, 2)) / sensitivity(0, 0), 1.414, 1e-3);
}

// 2.5: "the effect of cross coupling can be ignored".
TEST(ErrataChapter2, TheDatasheetsCrossAxisSensitivityIsHalfTheBiasOfTable51) {
  simulate::RigOptions rig = errata::wheel(0.0);  // x horizontal, y upwards
  rig.sensors[0].cross_axis[0] = sensor::adxl335.cross_axis;
  EXPECT_NEAR(errata::first(rig, "acc1_x"), 10.0 * mg, 0.01 * mg);
  EXPECT_GT(errata::first(rig, "acc1_x"), 0.5 * 19.68 * mg);
}

// (2.4): E = K1 + K1 A + K0 + ε.
TEST(ErrataChapter2, AnAdditiveScaleFactorIsMeasuredWithoutInput) {
  const sensor::ModelEquation volts{.K1 = 0.330 / g, .K0 = 0.2};
  const auto printed = [&](double accel) { return volts.K1 + volts.K1 * accel + volts.K0; };
  for (const double accel : {-g, 0.0, 3.0}) {
    const double ours = sensor::output(volts, {.ai_mps2 = accel});
    EXPECT_NEAR(ours, volts.K1 * (volts.K0 + accel), 1e-15);
    // 1 m/s² too much; and 0.2 V where 0.2 m/s² corresponds to 7 mV
    EXPECT_NEAR(printed(accel) - ours, volts.K1 + (1.0 - volts.K1) * volts.K0, 1e-15);
  }
}

// 3.1.2: "the only force acting on the sensor is gravity. Thus expected output is zero".
TEST(ErrataChapter3, OnATurningWheelTheRadialAxisReadsItsCentripetalAcceleration) {
  EXPECT_NEAR(errata::first(errata::wheel(errata::rpm_11), "acc1_x"), -13.5 * mg, 0.1 * mg);
  EXPECT_NEAR(errata::first(errata::wheel(21.0 * radps_per_rpm), "acc1_x"), -49.3 * mg, 0.1 * mg);
  // The other axis is not free of gravity either when this one is.
  EXPECT_NEAR(errata::first(errata::wheel(0.0), "acc1_y"), g, 1e-12);
}

// 3.3: "levelled with gravity vector so that x and y axis are orthogonal to gravity".
TEST(ErrataChapter3, OfTwoAxesInAVerticalPlaneBothAreNeverSquareToGravity) {
  for (int step = 0; step < 24; ++step) {
    const simulate::RigOptions rig = errata::wheel(0.0, step * rad_per_turn / 24.0);
    EXPECT_NEAR(std::hypot(errata::first(rig, "acc1_x"), errata::first(rig, "acc1_y")), g, 1e-12);
  }
}

// 3.2: "successive approximation 16 bit ADC"; 3.2.2: "48 KHz per channel".
TEST(ErrataChapter3, TheCardHasFourteenBitsAndSharesItsRate) {
  EXPECT_EQ(sensor::usb6009.bits_differential, 14);
  EXPECT_EQ(sensor::usb6009.bits_single_ended, 13);
  EXPECT_NEAR(sensor::lsb_v(5.0, sensor::usb6009.bits_differential) / (0.330 / g), 1.85 * mg,
              0.01 * mg);
  EXPECT_FALSE(sensor::usb6009.simultaneous);
  EXPECT_EQ(sensor::usb6009.rate_hz / 4.0, 12e3);  // for two axes of each of two sensors
}

// 3.2.1: "Bandwidth range of 200 Hz to 1 KHz" beside "0.1 µF for sensor frequency of 50 Hz".
TEST(ErrataChapter3, TwoHundredHertzAndATenthOfAMicrofaradAreNotOneFilter) {
  EXPECT_NEAR(sensor::filter_bandwidth_hz(sensor::adxl335, 0.1e-6), 50.0, 0.5);
  EXPECT_NEAR(sensor::filter_bandwidth_hz(sensor::adxl335, 25e-9), 200.0, 2.0);
  EXPECT_NEAR(sensor::filter_bandwidth_hz(sensor::adxl335, 5e-9), 1000.0, 10.0);
}

// 3.2.1: "The capacitor in series with output". A series capacitor would block constant signals.
TEST(ErrataChapter3, TheFilterLetsGravityThrough) {
  simulate::RigOptions rig = errata::wheel(0.0, std::numbers::pi / 2.0);
  rig.sensors[0].filter_signal = true;
  rig.sensors[0].bandwidth_hz = sensor::filter_bandwidth_hz(sensor::adxl335, 0.1e-6);
  const auto x = errata::column(simulate::simulate_rig(rig).value().recording, "acc1_x");
  const double time_constant_s = 1.0 / (rad_per_turn * rig.sensors[0].bandwidth_hz);
  ASSERT_GT(6.0, 1000.0 * time_constant_s);
  EXPECT_NEAR(x.back(), g, 1e-12);
}

}  // namespace
}  // namespace proofmass::thesis::errata_sensor_test
