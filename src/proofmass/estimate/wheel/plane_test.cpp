#include "proofmass/estimate/wheel/plane.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_plane_test {
namespace {

using test::Drive;
using test::Mount;
using test::record;
using test::rpm;

const Drive turning{{0.3, 20 * rpm}, {{8.0, 30 * rpm}}};

double dot(const Axis& a, const Axis& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

WheelPlane plane_of(const WheelSensor& sensor, const std::optional<Axis>& given = {}) {
  return find_plane(sensor, screen_rows(sensor), given).value();
}

void expect_right_handed(const WheelPlane& plane) {
  EXPECT_NEAR(dot(plane.axis, plane.axis), 1.0, 1e-12);
  EXPECT_NEAR(dot(plane.u, plane.u), 1.0, 1e-12);
  EXPECT_NEAR(dot(plane.v, plane.v), 1.0, 1e-12);
  EXPECT_NEAR(dot(plane.u, plane.v), 0.0, 1e-12);
  EXPECT_NEAR(dot(plane.axis, plane.u), 0.0, 1e-12);
  const Axis& u = plane.u;
  const Axis& v = plane.v;
  EXPECT_NEAR((u[0] * v[1] - u[1] * v[0]) * plane.axis[2] +
                  (u[1] * v[2] - u[2] * v[1]) * plane.axis[0] +
                  (u[2] * v[0] - u[0] * v[2]) * plane.axis[1],
              1.0, 1e-12);
}

TEST(WheelPlane, IsFoundWhicheverSensorAxisPointsAlongTheAxle) {
  const std::array<std::array<std::array<double, 3>, 3>, 3> turned{
      {{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}},    // axle along x
       {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}},    // along y
       {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}};  // along z
  for (std::size_t along = 0; along < 3; ++along) {
    Mount mount;
    mount.axes = turned[along];
    const WheelPlane plane = plane_of(record(turning, mount, 100.0, 1));
    EXPECT_NEAR(plane.axis[along], 1.0, 1e-6);
    EXPECT_NEAR(plane.u[(along + 1) % 3], 1.0, 1e-6);
    EXPECT_FALSE(plane.assumed);
    expect_right_handed(plane);
  }
}

TEST(WheelPlane, IsFoundForASensorMountedAtAnyAngle) {
  Mount mount;
  mount.axes = test::tilted(0.4, -0.3, 0.25);
  const WheelPlane plane = plane_of(record(turning, mount, 100.0, 1));
  EXPECT_NEAR(dot(plane.axis, mount.axes[2]), 1.0, 2e-6);  // within 2 mrad
  expect_right_handed(plane);
}

TEST(WheelPlane, OfAnAxleThatIsNotLevelTakesGravityAlongItAndNotTheAxis) {
  constexpr double tilt = 0.2;
  const WheelPlane plane = plane_of(record(turning, {}, 100.0, 1, {.axle_tilt_rad = tilt}));
  EXPECT_NEAR(plane.axis[2], 1.0, 1e-6);
  EXPECT_NEAR(plane.axial_mps2, standard_gravity_mps2 * std::sin(tilt), 0.01);
}

TEST(WheelPlane, OfAVehicleThatTurnsIsFoundDespiteItsLateralAcceleration) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k)
    sensor.accel_mps2[2][k] += 3.0 * std::sin(1.3 * sensor.time_s[k]);
  const WheelPlane plane = plane_of(sensor);
  EXPECT_NEAR(plane.axis[2], 1.0, 1e-3);
  EXPECT_FALSE(plane.assumed);
}

// A wheel at 30 to 40 rad/s under a vehicle that turns left at 0.3 rad/s, in its own axes: z along
// the axle. The Coriolis acceleration of the sensor is along the axle, and in phase with gravity's
// radial part.
WheelSensor fast_wheel_in_a_bend(bool with_gyroscope) {
  constexpr double lever_m = 0.15, yaw_radps = 0.3, rate_hz = 100.0;
  WheelSensor sensor;
  for (auto& axis : sensor.accel_mps2) axis.clear();
  double angle = 0.0;
  for (std::size_t k = 0; k < 4000; ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    const double speed = 35.0 + 5.0 * std::sin(0.3 * t), lateral = yaw_radps * 0.3 * speed;
    angle += speed / rate_hz;
    const double c = std::cos(angle), s = std::sin(angle);
    sensor.time_s.push_back(t);
    sensor.accel_mps2[0].push_back(standard_gravity_mps2 * c - speed * speed * lever_m);
    sensor.accel_mps2[1].push_back(-standard_gravity_mps2 * s);
    sensor.accel_mps2[2].push_back(lateral + 2.0 * yaw_radps * speed * lever_m * c);
    if (!with_gyroscope) continue;
    sensor.rate_radps[0].push_back(yaw_radps * c);
    sensor.rate_radps[1].push_back(-yaw_radps * s);
    sensor.rate_radps[2].push_back(speed);
  }
  return sensor;
}

TEST(WheelPlane, OfAFastWheelIsNotTurnedByTheCoriolisForceOfABend) {
  for (const bool with_gyroscope : {false, true}) {
    const WheelPlane plane = plane_of(fast_wheel_in_a_bend(with_gyroscope));
    EXPECT_NEAR(std::abs(plane.axis[2]), 1.0, 1e-4) << with_gyroscope;
    EXPECT_FALSE(plane.assumed);
  }
}

TEST(WheelPlane, IsThatOfTheGyroscopeWhereVibrationHidesTheRotationOfGravity) {
  WheelSensor sensor = fast_wheel_in_a_bend(true);
  for (std::size_t k = 0; k < sensor.time_s.size(); ++k)
    sensor.accel_mps2[2][k] += 20.0 * std::sin(2.1 * static_cast<double>(k * k));
  EXPECT_NEAR(plane_of(sensor).axis[2], 1.0, 1e-3);
  for (auto& axis : sensor.rate_radps) axis.clear();
  const auto found = find_plane(sensor, screen_rows(sensor), {});
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, Errc::not_observable);
}

TEST(WheelPlane, GivenIsTakenAtAnyLengthAndEitherWay) {
  const WheelPlane plane = plane_of(record(turning, {}, 100.0, 1), Axis{0.0, 0.0, -5.0});
  EXPECT_EQ(plane.axis, (Axis{0.0, 0.0, -1.0}));
  expect_right_handed(plane);
  const WheelSensor sensor = record(turning, {}, 100.0, 1);
  const auto none = find_plane(sensor, screen_rows(sensor), Axis{0.0, 0.0, 0.0});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, Errc::invalid_argument);
}

TEST(WheelPlane, OfATwoAxisSensorIsThatOfItsAxes) {
  Mount mount;
  mount.two_axes = true;
  const WheelPlane plane = plane_of(record(turning, mount, 100.0, 1));
  EXPECT_EQ(plane.axis, (Axis{0.0, 0.0, 1.0}));
  EXPECT_EQ(plane.u, (Axis{1.0, 0.0, 0.0}));
  EXPECT_EQ(plane.v, (Axis{0.0, 1.0, 0.0}));
}

TEST(WheelPlane, OfAWheelAtRestIsAssumedAndSaysSo) {
  const WheelPlane plane = plane_of(record({{0.3, 0.0}, {{5.0, 0.0}}}, {}, 100.0, 1));
  EXPECT_TRUE(plane.assumed);
  EXPECT_NEAR(plane.axis[2], 1.0, 1e-12);
}

TEST(WheelPlane, OneBadRowDoesNotTurnIt) {
  WheelSensor sensor = record(turning, {}, 400.0, 1);
  sensor.accel_mps2[2][700] = 5000.0;
  EXPECT_NEAR(plane_of(sensor).axis[2], 1.0, 1e-4);
}

TEST(WheelPlane, NeedsTenUsableRows) {
  WheelSensor sensor = record({{}, {{0.1, 0.0}}}, {}, 100.0, 1);
  ASSERT_EQ(sensor.time_s.size(), 11U);
  EXPECT_TRUE(find_plane(sensor, screen_rows(sensor), {}).has_value());
  test::spoil(sensor, 3, 0.0);
  test::spoil(sensor, 4, 0.0);
  const auto found = find_plane(sensor, screen_rows(sensor), {});
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, Errc::too_few_samples);
  EXPECT_EQ(found.error().message, "sensor: only 9 usable rows; a wheel needs at least 10");
}

TEST(WheelPlane, TurnedOverIsTheSamePlaneSeenFromTheOtherSide) {
  const WheelPlane plane = plane_of(record(turning, {}, 100.0, 1, {.axle_tilt_rad = 0.1}));
  const WheelPlane other = turned_over(plane);
  expect_right_handed(other);
  EXPECT_NEAR(dot(plane.axis, other.axis), -1.0, 1e-12);
  EXPECT_EQ(other.u, plane.u);
  EXPECT_EQ(other.axial_mps2, -plane.axial_mps2);
}

TEST(WheelPlane, ProjectsWhatIsUsableAndKeepsTheRestEmpty) {
  WheelSensor sensor = record(turning, {.noise_mps2 = 0.0}, 100.0, 1);
  test::spoil(sensor, 5, 3e34);
  const Screened screened = screen_rows(sensor);
  const PlanarReadings readings = project(sensor, screened, plane_of(sensor, Axis{0.0, 0.0, 1.0}));
  ASSERT_EQ(readings.u_mps2.size(), sensor.time_s.size());
  EXPECT_FALSE(readings.has(5));
  EXPECT_TRUE(readings.has(6));
  EXPECT_DOUBLE_EQ(readings.u_mps2[6], sensor.accel_mps2[0][6]);
  EXPECT_DOUBLE_EQ(readings.v_mps2[6], sensor.accel_mps2[1][6]);
}

/// A recording whose gyroscope has this function as its third channel.
template <class Reading>
PlanarReadings with_gyroscope(const Reading& reading) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  const std::size_t size = sensor.time_s.size();
  sensor.rate_radps = {std::vector<double>(size, 0.0), std::vector<double>(size, 0.0), {}};
  for (const double t : sensor.time_s) sensor.rate_radps[2].push_back(reading(t));
  return project(sensor, screen_rows(sensor), plane_of(sensor, Axis{0.0, 0.0, 1.0}));
}

// Axes that are not perpendicular to the axle by a hundredth, and a vehicle that turns once.
TEST(WheelPlane, KeepsOfTheRatesInThePlaneWhatATurningVehicleAdds) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  const auto vehicle = [](double t) { return t > 2.0 && t < 2.5 ? 1.5 : 0.0; };
  test::Normal normal(2);
  for (const double t : sensor.time_s) {
    const double speed = 2.0 + std::sin(t);
    sensor.rate_radps[0].push_back(0.01 * speed + 0.02 + vehicle(t) + 0.005 * normal());
    sensor.rate_radps[1].push_back(-0.02 * speed + 0.005 * normal());
    sensor.rate_radps[2].push_back(speed);
  }
  const PlanarReadings readings =
      project(sensor, screen_rows(sensor), plane_of(sensor, Axis{0.0, 0.0, 1.0}));
  EXPECT_NEAR(readings.leak_u.share, 0.01, 0.003);
  EXPECT_NEAR(readings.leak_u.bias_radps, 0.02, 0.006);
  EXPECT_NEAR(readings.leak_v.share, -0.02, 0.003);
  for (std::size_t row = 0; row < sensor.time_s.size(); ++row)
    EXPECT_NEAR(readings.rate_u_radps[row], vehicle(sensor.time_s[row]), 0.03) << row;
}

TEST(WheelPlane, IgnoresAConstantGyroscope) {
  const PlanarReadings readings = with_gyroscope([](double) { return 0.5; });
  EXPECT_TRUE(readings.constant_gyroscope);
  EXPECT_TRUE(readings.speed_radps.empty());
}

struct Spoilt {
  double value;
  const char* reason;
};

class ScreenRows : public testing::TestWithParam<Spoilt> {};

TEST_P(ScreenRows, CountsAndNamesWhatNoAccelerometerCanHaveMeant) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  for (const std::size_t row : {10U, 11U, 12U, 400U}) test::spoil(sensor, row, GetParam().value);
  const Screened screened = screen_rows(sensor);
  EXPECT_EQ(screened.unusable, 4U);
  ASSERT_EQ(screened.rejected.size(), 2U);
  EXPECT_EQ(screened.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(screened.rejected[0].rows, 3U);
  EXPECT_EQ(screened.rejected[0].start_s, sensor.time_s[10]);
  EXPECT_EQ(screened.rejected[0].end_s, sensor.time_s[12]);
  EXPECT_EQ(screened.rejected[1].rows, 1U);
  for (std::size_t row = 0; row < sensor.time_s.size(); ++row)
    EXPECT_EQ(screened.usable[row], !((row >= 10 && row <= 12) || row == 400)) << "row " << row;
}

INSTANTIATE_TEST_SUITE_P(
    All,
    ScreenRows,
    testing::Values(Spoilt{std::numeric_limits<double>::quiet_NaN(), "not a finite number"},
                    Spoilt{-std::numeric_limits<double>::infinity(), "not a finite number"},
                    Spoilt{3e34, "beyond 1000 g"},
                    Spoilt{-9900.0, "beyond 1000 g"},
                    Spoilt{1e-40, "denormal number"},
                    Spoilt{0.0, "all axes exactly zero"}));

TEST(ScreenRows, OneBadAxisSpoilsTheRow) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  sensor.accel_mps2[2][7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(screen_rows(sensor).unusable, 1U);
}

TEST(ScreenRows, AZeroOnOneAxisIsAReading) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  sensor.accel_mps2[0][7] = sensor.accel_mps2[1][8] = 0.0;
  EXPECT_EQ(screen_rows(sensor).unusable, 0U);
}

TEST(ScreenRows, ATimeThatDoesNotRiseIsLeftOutUntilItIsNewAgain) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  sensor.time_s[20] = sensor.time_s[19];
  sensor.time_s[21] = sensor.time_s[15];
  sensor.time_s[50] = std::numeric_limits<double>::quiet_NaN();
  const Screened screened = screen_rows(sensor);
  EXPECT_EQ(screened.unusable, 3U);
  ASSERT_EQ(screened.rejected.size(), 2U);
  EXPECT_EQ(screened.rejected[0].reason, "time does not rise");
  EXPECT_EQ(screened.rejected[0].rows, 2U);
  EXPECT_FALSE(screened.usable[50]);
  EXPECT_TRUE(screened.usable[22]);
  EXPECT_TRUE(std::isfinite(screened.rejected[1].start_s));
}

// One stamp far in the future must not make the rest of the recording late.
TEST(ScreenRows, AStampFarAheadCostsItselfAndNotTheRest) {
  WheelSensor sensor = record(turning, {}, 100.0, 1);
  sensor.time_s[20] = 1e9;
  EXPECT_LE(screen_rows(sensor).unusable, 2U);
}

TEST(GravityInPlane, OfALevelAxleIsAllOfItWhateverTheBiasAlongIt) {
  constexpr double g = standard_gravity_mps2;
  for (const double bias_mps2 : {-0.3, 0.0, 0.3}) {
    WheelPlane plane;
    plane.axial_mps2 = bias_mps2;
    const Uncertain in_plane = gravity_in_plane(plane, true, g, 0.02);
    EXPECT_NEAR(in_plane.value, g, 3.0 * in_plane.std) << bias_mps2;
    EXPECT_LT(in_plane.std, 1e-3 * g);
  }
}

TEST(GravityInPlane, OfATiltedAxleIsWhatTheTiltLeavesAsFarAsABiasLetsItBeSeen) {
  constexpr double g = standard_gravity_mps2, tilt_rad = 0.4, bias_mps2 = 0.3;
  WheelPlane plane;
  plane.axial_mps2 = g * std::sin(tilt_rad) + bias_mps2;
  const Uncertain in_plane = gravity_in_plane(plane, true, g, 0.02);
  EXPECT_NEAR(in_plane.value, g * std::cos(tilt_rad), 2.0 * in_plane.std);
  EXPECT_NEAR(in_plane.std, 0.5 * std::tan(tilt_rad), 0.03);  // ∂(g cos τ) due to a bias of 0.5
                                                              // m/s²
}

TEST(GravityInPlane, OfASensorOfTwoAxesIsALevelAxles) {
  WheelPlane plane;
  plane.axial_mps2 = 3.0;  // value of a channel that does not exist
  const Uncertain in_plane = gravity_in_plane(plane, false, standard_gravity_mps2, 0.02);
  EXPECT_NEAR(in_plane.value, standard_gravity_mps2, 3.0 * in_plane.std);
}

}  // namespace
}  // namespace proofmass::estimate::wheel_plane_test
