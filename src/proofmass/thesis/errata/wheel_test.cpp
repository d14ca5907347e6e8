#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/estimate/models/angular_model.hpp"
#include "proofmass/simulate/wheel_motion.hpp"
#include "proofmass/thesis/errata/errata_test_support.hpp"

// docs/errata.md, sections 4.4, 5.4 to 5.6 and A.2: the rotating wheel.
namespace proofmass::thesis::errata_wheel_test {
namespace {

using errata::g, errata::mg, errata::radius_m, errata::rpm_11;

constexpr double half_turn = std::numbers::pi;

// 4.4: "θ represents angle between radius R and earth gravity component".
TEST(ErrataChapter4, AlongTheRimGravityGoesWithTheCosineOfTheAngleFromTheHorizontal) {
  // With the spoke horizontal, gravity is entirely along the rim, where cos 90° would give none.
  EXPECT_NEAR(errata::first(errata::wheel(0.0, 0.0), "acc1_y"), g, 1e-12);
  EXPECT_NEAR(errata::first(errata::wheel(0.0, half_turn / 2.0), "acc1_y"), 0.0, 1e-12);
}

// (4.57), (4.58): along the radius only gravity.
TEST(ErrataChapter4, AlongTheRadiusTheCentripetalAccelerationIsRead) {
  const double start = 0.7, w = 21.0 * radps_per_rpm;
  const simulate::RigOptions rig = errata::wheel(w, start);
  EXPECT_NEAR(errata::first(rig, "acc1_x"), g * std::sin(start) - radius_m * w * w, 1e-12);
  EXPECT_NEAR(errata::first(rig, "acc2_x"), g * std::sin(start) + radius_m * w * w, 1e-12);
}

// (4.59): a1 = Rα + g cos θ, a2 = Rα − g cos θ require the second sensor to be rotated by half a
// turn (in contrast to 4.57 and 4.58, where g cos θ has the other signs); a bias common to both is
// then not cancelled.
TEST(ErrataChapter4, OfSensorsTurnedHalfRoundACommonBiasStaysInTheAngularAcceleration) {
  const double bias = 20.0 * mg, start = 0.4;
  simulate::RigOptions rig = errata::wheel(rpm_11, start);
  for (simulate::RigSensor& sensor : rig.sensors) sensor.bias_mps2 = {0.0, bias, 0.0};
  rig.sensors[1].mounting_rad = half_turn;
  const double a1 = errata::first(rig, "acc1_y"), a2 = errata::first(rig, "acc2_y");
  EXPECT_NEAR(a1, g * std::cos(start) + bias, 1e-12);
  EXPECT_NEAR(a2, -g * std::cos(start) + bias, 1e-12);
  EXPECT_NEAR((a1 + a2) / (2.0 * radius_m), 1.96, 0.01);  // rad/s², true value 0

  rig.sensors[1].mounting_rad = 0.0;
  const Uncertain parallel = estimate::angular_accel({.first_mps2 = errata::first(rig, "acc1_y"),
                                                      .second_mps2 = errata::first(rig, "acc2_y"),
                                                      .radius_m = radius_m});
  EXPECT_NEAR(parallel.value, 0.0, 1e-11);
}

// 4.4: "Angular acceleration= Radius * Linear Acceleration … directly proportional to the
// distance".
TEST(ErrataChapter4, AtTwiceTheRadiusTheSameForceIsHalfTheAngularAcceleration) {
  const auto at = [](double radius) {
    return estimate::angular_accel({.first_mps2 = 0.3, .second_mps2 = -0.3, .radius_m = radius});
  };
  EXPECT_NEAR(at(0.1).value, 3.0, 1e-14);
  EXPECT_NEAR(at(0.2).value, 1.5, 1e-14);
}

// 5.1.2: the tumble test "when accelerometer sensor is rotating on the wheel".
TEST(ErrataChapter5, ReadWhileItTurnsTheRadialAxisHasABiasThatIsNone) {
  const auto at = [](double quarter) {
    return errata::first(errata::wheel(rpm_11, quarter * half_turn / 2.0), "acc1_x");
  };
  const auto found =
      calibrate::four_point({.E0 = at(0), .E90 = at(1), .E180 = at(2), .E270 = at(3)}, g);
  EXPECT_NEAR(found.bias_0g_mps2, -13.5 * mg, 0.1 * mg);
  EXPECT_NEAR(found.K1, 1.0, 1e-12);
}

simulate::WheelMotion turning(const simulate::SpeedRipple& ripple = {}) {
  return {0.0, {{.duration_s = 60.0, .speed_radps = rpm_11}}, ripple, 1};
}

// 5.4.1: "2*pi*R= 62.83cm = 0.62m for first five seconds".
TEST(ErrataChapter5, OneTurnTakesFiveAndAHalfSecondsAndEndsWhereItBegan) {
  EXPECT_NEAR(turning().at(60.0 / 11.0).angle_rad, rad_per_turn, 1e-12);
  EXPECT_NEAR(radius_m * turning().at(60.0 / 11.0).angle_rad, 0.628, 5e-4);
  EXPECT_NEAR(radius_m * turning().at(5.0).angle_rad, 0.576, 5e-4);
  const double end = turning().at(60.0 / 11.0).angle_rad;
  EXPECT_NEAR(radius_m * std::hypot(std::cos(end) - 1.0, std::sin(end)), 0.0, 1e-12);
}

/// Largest distance of the mean of two channels in one turn, integrated twice from rest.
double farthest_m(const simulate::RigOptions& rig, std::string_view one, std::string_view other) {
  const Recording recording = simulate::simulate_rig(rig).value().recording;
  const std::vector<double> a = errata::column(recording, one),
                            b = errata::column(recording, other);
  const double dt = 1.0 / rig.rate_hz;
  double v = 0.0, p = 0.0, far = 0.0;
  const auto turn = static_cast<std::size_t>(60.0 / 11.0 / dt);
  for (std::size_t k = 1; k <= turn; ++k) {
    const double before = 0.5 * (a[k - 1] + b[k - 1]), now = 0.5 * (a[k] + b[k]);
    p += dt * v + dt * dt * (before / 3.0 + now / 6.0);
    v += 0.5 * dt * (before + now);
    far = std::max(far, std::abs(p));
  }
  return far;
}

// 5.4: position "by fusing raw acceleration data", y1 + y2 and x1 + x2, errors of 6.88 m and 9 m.
TEST(ErrataChapter5, TheSumOfOppositeSensorsIntegratedTwiceIsGravityAndNoPath) {
  simulate::RigOptions rig = errata::wheel(rpm_11);
  // ∬ g cos ωt = g/ω² (1 − cos ωt): metres, for a path of 0.63 m.
  EXPECT_NEAR(farthest_m(rig, "acc1_y", "acc2_y"), 2.0 * g / (rpm_11 * rpm_11), 0.01);
  EXPECT_GT(farthest_m(rig, "acc1_y", "acc2_y"), 14.7);
  // With the second sensor rotated by half a turn gravity cancels and nothing remains.
  rig.sensors[1].mounting_rad = half_turn;
  EXPECT_LT(farthest_m(rig, "acc1_y", "acc2_y"), 1e-9);
}

// 5.6: "θ = ω (t_i − t_1)".
TEST(ErrataChapter5, WhereTheSpeedRipplesSpeedTimesTimeIsDegreesOff) {
  const auto worst_deg = [](const simulate::WheelMotion& wheel) {
    double worst = 0.0;
    for (double t = 0.0; t <= 60.0; t += 0.05)
      worst = std::max(worst, std::abs(wheel.at(t).angle_rad - rpm_11 * t) / rad_per_deg);
    return worst;
  };
  EXPECT_LT(worst_deg(turning()), 1e-9);
  EXPECT_GT(worst_deg(turning({.fraction = 0.02})), 1.0);
  EXPECT_GT(worst_deg(turning({.fraction = 0.1})), 5.0);  // A.2.1: speed regulation 10 to 30 %
}

// A.2: "Angular Velocity = rotation * perimeter of rotating wheel" = 0.1726 m/s.
TEST(ErrataAppendixA, RevolutionsTimesPerimeterIsTheSpeedOfTheRim) {
  const double speed = turning().at(1.0).speed_radps;
  EXPECT_NEAR(speed, 1.152, 5e-4);
  EXPECT_NEAR(0.15 * speed, 0.1728, 5e-5);
  EXPECT_NEAR(radius_m * speed, 0.1152, 5e-5);  // speed of the sensor
}

// A.2: "P_out = 0.32*0.066 = 0.0211 watts".
TEST(ErrataAppendixA, TorqueTimesTheAngleOfAMinuteIsTheWorkOfAMinute) {
  const double work_j = 0.32 * turning().at(60.0).angle_rad;
  EXPECT_NEAR(work_j / 60.0, 0.369, 5e-4);
  EXPECT_GT(work_j / 60.0, 17.0 * 0.0211);
}

// A.2: "torque and rotational speed is inversely proportional to each other".
TEST(ErrataAppendixA, TheTorqueOfAMotorFallsAlongALine) {
  // V = r i + k ω, τ = k i: the circuit of a motor with a permanent magnet.
  constexpr double V = 90.0, r = 8.0, k = 25.0;
  const auto torque = [](double w) { return k * (V - k * w) / r; };
  const double stall = torque(0.0), no_load = V / k;
  EXPECT_NEAR(torque(no_load), 0.0, 1e-9);
  for (const double share : {0.25, 0.5, 0.75})
    EXPECT_NEAR(torque(share * no_load), stall * (1.0 - share), 1e-9);
  EXPECT_GT(torque(0.5 * no_load) * 0.5 * no_load, 1.3 * torque(0.25 * no_load) * 0.25 * no_load);
}

// Table A.1: "DC controller Current settings(A)", 2 to 7.
TEST(ErrataAppendixA, TheSettingsOfTheControllerAreNotAmperes) {
  constexpr double hp_w = 745.7, full_load_a = 1.27, supply_v = 90.0;  // A.2.1
  EXPECT_GT(2.0, 1.5 * full_load_a);
  EXPECT_GT(7.0 * supply_v, 5.0 * full_load_a * supply_v);
  EXPECT_GT(full_load_a * supply_v, hp_w / 8.0);  // these two figures of A.2.1 agree
  // 220 in lb at 31 rpm, 81 W, are below 1/8 hp.
  EXPECT_LT(220.0 * 0.112985 * 31.0 * radps_per_rpm, hp_w / 8.0);
}

}  // namespace
}  // namespace proofmass::thesis::errata_wheel_test
