#include "proofmass/calibrate/rotation.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/calibrate/rotation_test_support.hpp"

namespace proofmass::calibrate::rotation_test {
namespace {

using Q = RotationQuantity;
constexpr double g = standard_gravity_mps2;

double value_of(const RotationAxis& axis, Q quantity) {
  return axis[quantity].value.value().value;
}

PlainWheel nonlinear_wheel() {
  PlainWheel wheel;
  wheel.equations = {{.K1 = 0.0336, .K0 = 0.2, .K2 = 8e-5, .K3 = 5e-6, .Kip = -6e-5, .Kpp = 2e-5}};
  return wheel;
}

void expect_coefficients(const RotationAxis& axis, const sensor::ModelEquation& truth, double by) {
  EXPECT_NEAR(value_of(axis, Q::K1), truth.K1, by * truth.K1);
  EXPECT_NEAR(value_of(axis, Q::K2_minus_Kpp), truth.K2 - truth.Kpp, by / g);
  EXPECT_NEAR(value_of(axis, Q::Kip), truth.Kip, by / g);
  EXPECT_NEAR(value_of(axis, Q::K3), truth.K3, 4.0 * by / (g * g));
}

TEST(Rotation, FindsTheCoefficientsOfOneAxisWithoutAnEncoder) {
  const PlainWheel wheel = nonlinear_wheel();
  const RotationFit fit = fit_of({turned(wheel)});
  ASSERT_EQ(fit.axes.size(), 1U);
  expect_coefficients(fit.axes[0], wheel.equations[0], 1e-6);
  EXPECT_NEAR(value_of(fit.axes[0], Q::K0_radial), 0.2 + 2e-5 * g * g, 1e-5);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.turns, 35.0, 1.0);
  EXPECT_EQ(fit.axes[0][Q::misalignment].reason,
            "without an encoder the misalignment is part of the phase");
}

TEST(Rotation, DeterminesTheMisalignmentWithAnEncoder) {
  PlainWheel wheel = nonlinear_wheel();
  wheel.equations[0].delta_o = 0.012;
  wheel.give_angle = true;
  const RotationFit fit = fit_of({turned(wheel)});
  expect_coefficients(fit.axes[0], wheel.equations[0], 1e-9);
  EXPECT_NEAR(value_of(fit.axes[0], Q::misalignment), 0.012, 1e-8);
}

TEST(Rotation, TakesAnEncodersAngleWrappedOrRunningBackwards) {
  PlainWheel wheel = nonlinear_wheel();
  wheel.equations[0].delta_o = 0.012;
  wheel.give_angle = true;
  RotationRecording wrapped = turned(wheel);
  for (double& angle : wrapped.angle_rad) angle = std::remainder(angle, rad_per_turn);
  EXPECT_NEAR(value_of(fit_of({wrapped}).axes[0], Q::misalignment), 0.012, 1e-8);
  wheel.angle = [](double t) { return -1.152 * t; };
  const RotationFit back = fit_of({turned(wheel)});
  EXPECT_NEAR(value_of(back.axes[0], Q::misalignment), 0.012, 1e-8);
  EXPECT_NEAR(value_of(back.axes[0], Q::Kip), -6e-5, 1e-9);
}

// The zero was taken for that of the sensor: K1 was K1 cos 0.7.
TEST(Rotation, FindsTheScaleFactorWhateverTheEncodersZero) {
  PlainWheel wheel = nonlinear_wheel();
  wheel.give_angle = true;
  const auto counted_from = [&](double zero_rad, double speed_radps) {
    wheel.angle = [=](double t) { return speed_radps * t; };
    RotationRecording recording = turned(wheel);
    for (double& angle : recording.angle_rad) angle -= zero_rad;
    return recording;
  };
  const RotationFit common = fit_of({counted_from(0.7, 1.152), counted_from(0.7, 2.2)});
  expect_coefficients(common.axes[0], wheel.equations[0], 1e-7);
  EXPECT_EQ(common.axes[0][Q::misalignment].reason,
            "the zero of the encoder's angle is not that of the sensor's axes");
  EXPECT_TRUE(common.axes[0].delay_s);
  const RotationFit own = fit_of({counted_from(0.7, 1.152), counted_from(-1.9, 2.2)});
  expect_coefficients(own.axes[0], wheel.equations[0], 1e-7);
  EXPECT_FALSE(own.axes[0][Q::misalignment].value);
  EXPECT_FALSE(own.axes[0].delay_s);
}

TEST(Rotation, DoesNotSeparateRadiusAndBiasAtOneSpeed) {
  PlainWheel wheel = nonlinear_wheel();
  wheel.radius_m = 0.1;
  const RotationFit fit = fit_of({turned(wheel)});
  const std::string reason =
      "radius and radial bias are not separable at one speed: record a second speed";
  EXPECT_FALSE(fit.radius.value);
  EXPECT_EQ(fit.radius.reason, reason);
  EXPECT_EQ(fit.axes[0][Q::K0].reason, reason);
  EXPECT_NEAR(value_of(fit.axes[0], Q::K0_radial), 0.2 + 2e-5 * g * g - 0.1 * 1.152 * 1.152, 1e-5);
}

TEST(Rotation, SeparatesRadiusAndBiasInTwoRecordingsAtTwoSpeeds) {
  PlainWheel slow, fast;
  slow.radius_m = fast.radius_m = 0.1;
  slow.equations[0].K0 = fast.equations[0].K0 = 0.2;
  fast.angle = [](double t) { return 2.2 * t; };
  const RotationFit fit = fit_of({turned(slow), turned(fast)});
  EXPECT_NEAR(fit.radius.value.value().value, 0.1, 1e-7);
  EXPECT_NEAR(value_of(fit.axes[0], Q::K0), 0.2, 1e-7);
  EXPECT_EQ(fit.sections.size(), 2U);
}

// 11 rpm, a ramp of 20 s, 21 rpm: the ramp is excluded.
TEST(Rotation, SeparatesThemInOneRecordingWithTwoSpeeds) {
  PlainWheel wheel;
  wheel.radius_m = 0.1;
  wheel.duration_s = 320.0;
  wheel.equations[0].K0 = 0.2;
  wheel.angle = [](double t) {
    const double u = std::clamp(t - 150.0, 0.0, 20.0);
    return 1.152 * t + 1.047 * (u * u / 40.0 + std::max(t - 170.0, 0.0));
  };
  const RotationFit fit = fit_of({turned(wheel)});
  EXPECT_EQ(fit.sections.size(), 2U);
  EXPECT_NEAR(fit.radius.value.value().value, 0.1, 2e-3);
  EXPECT_NEAR(value_of(fit.axes[0], Q::K0), 0.2, 5e-3);
}

// Both axes together determine their radius for any mounting angle.
TEST(Rotation, FindsTheRadiusOfTwoAxesMountedAtAnyAngle) {
  for (const double mounting : {0.0, 0.9, 2.5, -1.9}) {
    PlainWheel slow, fast;
    slow.equations = fast.equations = {{.K1 = 1.0, .K0 = 0.1}, {.K1 = 1.02, .K0 = -0.2}};
    slow.radius_m = fast.radius_m = 0.1;
    slow.mounting_rad = fast.mounting_rad = mounting;
    fast.angle = [](double t) { return 2.2 * t; };
    const RotationFit fit = fit_of({turned(slow), turned(fast)});
    EXPECT_NEAR(fit.radius.value.value().value, 0.1, 1e-6) << mounting;
    EXPECT_NEAR(value_of(fit.axes[0], Q::radius), 0.1 * std::cos(mounting), 1e-6);
    EXPECT_NEAR(value_of(fit.axes[1], Q::radius), -0.1 * std::sin(mounting), 1e-6);
    EXPECT_EQ(fit.direction, 1);
  }
}

TEST(Rotation, SeesWhichWayTwoAxesTurnAndHowFarTheyAreFromSquare) {
  for (const int hand : {1, -1}) {
    PlainWheel wheel;
    wheel.equations = {{.K1 = 1.0, .Kip = 3e-4}, {.K1 = 0.98, .K2 = 2e-4, .delta_o = 0.015}};
    wheel.hand = hand;
    const RotationFit fit = fit_of({turned(wheel)});
    EXPECT_EQ(fit.direction, hand);
    EXPECT_NEAR(value_of(fit.axes[0], Q::Kip), 3e-4, 1e-7);
    EXPECT_NEAR(value_of(fit.axes[1], Q::K2_minus_Kpp), 2e-4, 1e-7);
    EXPECT_NEAR(value_of(fit.axes[1], Q::misalignment), 0.015, 1e-6);
  }
}

TEST(Rotation, FollowsASlowlyDriftingSpeed) {
  PlainWheel wheel = nonlinear_wheel();
  wheel.duration_s = 600.0;
  wheel.angle = [](double t) {
    return 1.152 * t + 0.8 * std::sin(2.0 * std::numbers::pi * t / 150.0);
  };
  const RotationFit fit = fit_of({turned(wheel)});
  expect_coefficients(fit.axes[0], wheel.equations[0], 2e-4);
}

// ω (1 + 0.01 cos θ), for comparison with the effect on one axis stated in the note.
std::function<double(double)> rippled(int per_turn, double size) {
  return [=](double t) {
    const double theta = 1.152 * t;
    return theta + size / per_turn * std::sin(per_turn * theta + 0.4);
  };
}

// With a single axis, ripples of 1 %, ε = 0.01 cos φ and ε = 0.005 sin 2φ, are attributed to the
// sensor. The first affects both harmonics of K0 = B0 + C2, the second both of K1 = S1 + 3 S3.
TEST(Rotation, StatesTheEffectOfARippleOfOnePerCentOnOneAxis) {
  PlainWheel wheel;
  wheel.angle = [](double t) { return 1.152 * t + 0.01 * std::cos(1.152 * t); };
  const RotationFit once = fit_of({turned(wheel)});
  EXPECT_NEAR(once.per_percent.bias_mps2, 0.01 * g, 1e-12);
  EXPECT_NEAR(std::abs(value_of(once.axes[0], Q::K0_radial)), once.per_percent.bias_mps2,
              0.02 * once.per_percent.bias_mps2);
  EXPECT_NEAR(std::abs(value_of(once.axes[0], Q::K2_minus_Kpp)), once.per_percent.second_order_s2pm,
              0.02 * once.per_percent.second_order_s2pm);
  wheel.angle = [](double t) { return 1.152 * t + 0.005 * std::sin(2.304 * t); };
  const RotationFit twice = fit_of({turned(wheel)});
  EXPECT_NEAR(twice.per_percent.scale_relative, 0.01, 1e-12);
  EXPECT_NEAR(std::abs(value_of(twice.axes[0], Q::K1) / 0.0336 - 1.0), 0.01, 3e-4);
  EXPECT_NEAR(std::abs(value_of(twice.axes[0], Q::K3)), twice.per_percent.third_order_s4pm2,
              0.05 * twice.per_percent.third_order_s4pm2);
}

// The interval includes the possible effect of a ripple.
TEST(Rotation, IncludesAPossibleRippleInTheIntervalOfOneAxis) {
  for (const int per_turn : {1, 2, 3}) {
    PlainWheel wheel;
    wheel.angle = rippled(per_turn, 0.01);
    wheel.white = 1e-4;
    const RotationAxis axis = fit_of({turned(wheel)}).axes[0];
    for (const Q quantity : {Q::K1, Q::K0_radial, Q::K2_minus_Kpp, Q::Kip, Q::K3})
      EXPECT_NEAR(value_of(axis, quantity), quantity == Q::K1 ? 0.0336 : 0.0,
                  axis[quantity].half_width_95)
          << name_of(quantity) << ", " << per_turn;
  }
}

TEST(Rotation, TakesARippleOutWhereTwoAxesShareIt) {
  for (const int per_turn : {1, 2}) {
    PlainWheel wheel;
    wheel.equations = {{.K1 = 1.0, .K0 = 0.1}, {.K1 = 1.0, .K0 = -0.1, .delta_o = 0.01}};
    wheel.angle = rippled(per_turn, 0.01);
    wheel.white = 0.01;
    const RotationFit fit = fit_of({turned(wheel)});
    const SpeedRipple& ripple = fit.ripples.at(static_cast<std::size_t>(per_turn - 1));
    EXPECT_TRUE(ripple.accepted) << per_turn << " " << ripple.chance_p;
    EXPECT_NEAR(ripple.amplitude.value().value, 0.01, 5e-4);
    EXPECT_NEAR(value_of(fit.axes[0], Q::K0_radial), 0.1, 2e-3);
    EXPECT_NEAR(value_of(fit.axes[1], Q::K0_radial), -0.1, 2e-3);
    EXPECT_NEAR(value_of(fit.axes[0], Q::K1), 1.0, 3e-4);
    EXPECT_NEAR(value_of(fit.axes[1], Q::misalignment), 0.01, 4e-4);
    EXPECT_FALSE(fit.axes[0][per_turn == 1 ? Q::Kip : Q::K3].value);
  }
}

// The ripple also modulates r ω² once per turn, by as much as 0.2 % of K1 here.
TEST(Rotation, TakesOutWhatARippleMakesOfTheCentripetalAcceleration) {
  for (const double mounting : {0.0, 1.1}) {
    PlainWheel slow, fast;
    slow.equations = fast.equations = {{.K1 = 1.0}, {.K1 = 1.0, .delta_o = 0.01}};
    slow.radius_m = fast.radius_m = 0.1;
    slow.mounting_rad = fast.mounting_rad = mounting;
    slow.white = fast.white = 0.01;
    slow.angle = rippled(1, 0.02);
    fast.angle = [](double t) { return 2.2 * t + 0.02 * std::sin(2.2 * t + 0.4); };
    const RotationFit fit = fit_of({turned(slow), turned(fast)});
    EXPECT_TRUE(fit.ripples.at(0).accepted);
    EXPECT_NEAR(value_of(fit.axes[0], Q::K1), 1.0, 5e-4);
    EXPECT_NEAR(value_of(fit.axes[1], Q::K1), 1.0, 5e-4);
    EXPECT_NEAR(value_of(fit.axes[1], Q::misalignment), 0.01, 5e-4);
  }
}

// Two speeds, each with its own ripples at one to three times per turn.
std::vector<RotationRecording> rippling_pair(double radius_m,
                                             bool encoder,
                                             double white,
                                             unsigned seed) {
  std::vector<RotationRecording> pair;
  for (const double speed : {1.3, 2.7}) {
    PlainWheel wheel;
    wheel.equations = {{.K1 = 1.0, .K0 = 0.1}, {.K1 = 1.02, .K0 = -0.2, .delta_o = 0.01}};
    wheel.radius_m = radius_m;
    wheel.mounting_rad = encoder ? 0.0 : 0.6;
    wheel.give_angle = encoder;
    wheel.duration_s = 100.0;
    wheel.white = white;
    wheel.seed = seed++;
    wheel.angle = [=](double t) {
      const double even = speed * t;
      return even + 0.02 * std::sin(even + speed) + 0.005 * std::sin(2.0 * even + 3.0 * speed) +
             0.004 * std::cos(3.0 * even - speed);
    };
    pair.push_back(turned(wheel));
  }
  return pair;
}

// r ω̇ of the n-th ripple is proportional to n² r ω²/g, which is above 1 from the third on here.
TEST(Rotation, FindsALargeRadiusFromTwoSpeedsThatRipple) {
  const RotationFit fit = fit_of(rippling_pair(0.19, false, 0.0, 1));
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.radius.value.value().value, 0.19, 5e-5);
}

// The mean of ω² includes the square of the ripple.
TEST(Rotation, FindsTheRadiusOfAWheelThatRipplesBesideAnEncoder) {
  const RotationFit fit = fit_of(rippling_pair(0.1, true, 0.0, 1));
  EXPECT_NEAR(fit.radius.value.value().value, 0.1, 5e-6);
}

// The noise of each speed's ripple enters its bias, and thus the radius from the two speeds.
TEST(Rotation, IncludesTheRipplesOfBothSpeedsInTheRadius) {
  constexpr unsigned wheels = 30;
  double squares = 0.0;
  for (unsigned k = 0; k < wheels; ++k) {
    const Uncertain radius =
        fit_of(rippling_pair(0.1, false, 0.02, 2 * k + 1)).radius.value.value();
    squares += std::pow((radius.value - 0.1) / radius.std, 2.0);
  }
  EXPECT_LT(squares / wheels, 1.0 + 2.0 * std::sqrt(2.0 / wheels));
  EXPECT_GT(squares / wheels, 0.3);
}

TEST(Rotation, DoesNotTakeASensorsNonlinearityForARipple) {
  PlainWheel wheel;
  wheel.equations = {{.K1 = 1.0, .K2 = 1e-3}, {.K1 = 1.0, .K2 = 1e-3}};
  wheel.white = 0.01;
  const RotationFit fit = fit_of({turned(wheel)});
  EXPECT_FALSE(fit.ripples.at(0).accepted);
  EXPECT_NEAR(value_of(fit.axes[0], Q::K2_minus_Kpp), 1e-3, 1e-4);
  // Half of it could be due to a ripple.
  EXPECT_GT(fit.axes[0][Q::K2_minus_Kpp].half_width_95, 5e-4);
}

// Simultaneous ripples of a bearing, a belt and a motor.
TEST(Rotation, TakesOutRipplesOnceTwiceAndThreeTimesATurnTogether) {
  PlainWheel wheel;
  wheel.equations = {{.K1 = 1.0, .K0 = 0.1}, {.K1 = 1.0, .K0 = -0.1, .delta_o = 0.01}};
  wheel.angle = [](double t) {
    const double theta = 2.1 * t;
    return theta + 0.02 * std::sin(theta + 0.3) + 0.008 * std::cos(2.0 * theta) +
           0.004 * std::sin(3.0 * theta + 1.0);
  };
  wheel.white = 0.01;
  const RotationFit fit = fit_of({turned(wheel)});
  for (const std::size_t n : {0U, 1U, 2U}) EXPECT_TRUE(fit.ripples.at(n).accepted) << n;
  EXPECT_FALSE(fit.ripples.at(3).accepted);
  EXPECT_NEAR(fit.ripples.at(2).amplitude.value().value, 0.012, 5e-4);
  const std::array biases{0.1, -0.1};
  for (const std::size_t k : {0U, 1U}) {
    const RotationAxis& axis = fit.axes[k];
    EXPECT_NEAR(value_of(axis, Q::K1), 1.0, 5e-4);
    EXPECT_LT(std::abs(value_of(axis, Q::K1) - 1.0), axis[Q::K1].half_width_95);
    EXPECT_NEAR(value_of(axis, Q::K0_radial), biases[k], 3e-3);
    EXPECT_FALSE(axis[Q::K2_minus_Kpp].value || axis[Q::Kip].value || axis[Q::K3].value);
  }
  EXPECT_NEAR(value_of(fit.axes[1], Q::misalignment), 0.01, 5e-4);
}

// A one-pole filter at 10 Hz: τ = 16 ms. At one speed ω τ is confounded with a misalignment; at two
// it is not.
TEST(Rotation, DistinguishesADelayFromAMisalignmentAtTwoSpeedsOnly) {
  const double tau = 1.0 / (rad_per_turn * 10.0);
  const auto delayed = [&](double speed) {
    PlainWheel wheel;
    wheel.equations[0].delta_o = 0.012;
    wheel.angle = [=](double t) { return speed * t; };
    wheel.give_angle = true;
    RotationRecording recording = turned(wheel);
    wheel.angle = [=](double t) { return speed * t - std::atan(speed * tau); };
    recording.axes = turned(wheel).axes;
    for (double& e : recording.axes[0]) e /= std::hypot(1.0, speed * tau);
    return recording;
  };
  const RotationAxis one = fit_of({delayed(2.0)}).axes[0];
  EXPECT_NEAR(value_of(one, Q::misalignment), 0.012 - 2.0 * tau, 1e-4);
  EXPECT_LT(std::abs(value_of(one, Q::misalignment) - 0.012), one[Q::misalignment].half_width_95);
  const RotationAxis two = fit_of({delayed(1.0), delayed(2.0)}).axes[0];
  EXPECT_NEAR(value_of(two, Q::misalignment), 0.012, 1e-4);
  EXPECT_NEAR(two.delay_s.value().value, tau, 1e-4);
  EXPECT_NEAR(value_of(two, Q::K1), 0.0336, 1e-5);
  const RotationAxis both_ways = fit_of({delayed(1.5), delayed(-1.5)}).axes[0];
  EXPECT_NEAR(value_of(both_ways, Q::misalignment), 0.012, 1e-4);
  const RotationAxis stated =
      fit_rotation(std::vector{delayed(2.0)}, {.gravity_mps2 = g, .bandwidth_hz = 10.0})
          .value()
          .axes[0];
  EXPECT_NEAR(value_of(stated, Q::misalignment), 0.012, 1e-4);
  EXPECT_LT(stated[Q::misalignment].half_width_95, 1e-5);
}

// The effects of r ω² and r ω̇ once per turn are in the interval if one speed does not determine
// the radius.
TEST(Rotation, AllowsForTheRadiusOfARippleAtOneSpeed) {
  PlainWheel wheel;
  wheel.equations = {{.K1 = 1.0}, {.K1 = 1.0, .delta_o = 0.01}};
  wheel.angle = [](double t) { return 2.5 * t + 0.02 * std::sin(2.5 * t + 0.4); };
  wheel.radius_m = 0.15;
  wheel.mounting_rad = 0.8;
  wheel.white = 0.01;
  const RotationFit fit = fit_of({turned(wheel)});
  EXPECT_TRUE(fit.ripples.at(0).accepted);
  for (const RotationAxis& axis : fit.axes)
    EXPECT_LT(std::abs(value_of(axis, Q::K1) - 1.0), axis[Q::K1].half_width_95);
  EXPECT_GT(std::abs(value_of(fit.axes[0], Q::K1) - 1.0), 1e-3);
  EXPECT_LT(std::abs(value_of(fit.axes[1], Q::misalignment) - 0.01),
            fit.axes[1][Q::misalignment].half_width_95);
}

TEST(Rotation, ExcludesGapsAndNonFiniteSamples) {
  PlainWheel wheel = nonlinear_wheel();
  wheel.duration_s = 300.0;
  RotationRecording recording = turned(wheel);
  for (std::size_t k = 3000; k < 3300; k += 7) {
    recording.axes[0][k] = std::numeric_limits<double>::quiet_NaN();
  }
  recording.time_s.erase(recording.time_s.begin() + 6000, recording.time_s.begin() + 6100);
  recording.axes[0].erase(recording.axes[0].begin() + 6000, recording.axes[0].begin() + 6100);
  const RotationFit fit = fit_of({recording});
  EXPECT_EQ(fit.sections.size(), 2U);
  expect_coefficients(fit.axes[0], wheel.equations[0], 1e-6);
}

TEST(Rotation, FoldsTheReadingsOverTheTurns) {
  const RotationFit fit = fit_of({turned(nonlinear_wheel())});
  const RotationFold& fold = fit.axes[0].fold;
  ASSERT_EQ(fold.mean.size(), 72U);
  const auto top = std::ranges::max_element(fold.mean) - fold.mean.begin();
  EXPECT_NEAR(fold.angle_rad[static_cast<std::size_t>(top)], std::numbers::pi / 2.0, 0.1);
  for (const double residual : fold.residual) EXPECT_LT(std::abs(residual), 1e-7);
}

TEST(Rotation, DoubtsAWheelWhoseAxleMoves) {
  PlainWheel wheel;
  wheel.equations[0].K1 = 1.0;
  RotationRecording recording = turned(wheel);
  for (std::size_t k = 0; k < recording.time_s.size(); ++k) {
    recording.axes[0][k] += 1.5 * std::sin(17.0 * recording.time_s[k]);
  }
  const RotationFit fit = fit_of({recording});
  ASSERT_FALSE(fit.doubts.empty());
  EXPECT_NE(fit.doubts[0].find("whose axle is stationary"), std::string::npos);
  for (std::size_t k = 0; k < recording.time_s.size(); ++k) {
    recording.axes[0][k] += 8.0 * std::sin(17.0 * recording.time_s[k]);
  }
  const auto refused = fit_rotation(std::vector{recording}, {.gravity_mps2 = g});
  ASSERT_FALSE(refused);
}

TEST(Rotation, DoubtsAScaleFactorThatCannotBe) {
  PlainWheel wheel;
  wheel.equations[0].K1 = 0.5;
  const auto fit = fit_rotation(std::vector{turned(wheel)},
                                {.gravity_mps2 = g, .readings_are_accelerations = true});
  EXPECT_EQ(fit.value().doubts.size(), 1U);
}

TEST(Rotation, RefusesUnsuitableRecordings) {
  const auto code = [](const std::vector<RotationRecording>& recordings) {
    return fit_rotation(recordings, {.gravity_mps2 = g}).error().code;
  };
  EXPECT_EQ(code({}), Errc::invalid_argument);
  PlainWheel wheel;
  wheel.duration_s = 40.0;
  EXPECT_EQ(code({turned(wheel)}), Errc::too_few_samples);
  wheel.duration_s = 200.0;
  wheel.rate_hz = 2.0;
  EXPECT_EQ(code({turned(wheel)}), Errc::too_few_samples);
  RotationRecording still{"still", {0.0, 1.0, 2.0}, {{1.0, 1.0, 1.0}}, {}};
  EXPECT_EQ(code({still}), Errc::too_few_samples);
  still.time_s[2] = 0.5;
  EXPECT_EQ(code({still}), Errc::not_finite);
  still.axes[0].pop_back();
  EXPECT_EQ(code({still}), Errc::invalid_argument);
  wheel = {};
  wheel.equations = {{.K1 = 1.0}, {.K1 = 1.0}};
  RotationRecording same = turned(wheel);
  same.axes[1] = same.axes[0];
  EXPECT_EQ(code({same}), Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::calibrate::rotation_test
