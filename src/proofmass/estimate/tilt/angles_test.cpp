#include "proofmass/estimate/tilt/angles.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "proofmass/core/random.hpp"
#include "proofmass/core/so3.hpp"
#include "proofmass/estimate/tilt/calibration.hpp"
#include "proofmass/estimate/tilt_test_support.hpp"

namespace proofmass::estimate::tilt_angles_test {
namespace {

constexpr double g = 9.80665, none = std::numeric_limits<double>::quiet_NaN();
const Mat<3, 3> small = 1e-6 * Mat<3, 3>::Identity();

TEST(TiltAngles, AreThoseOfTheRotationThatTheyAreDefinedBy) {
  for (const double roll : {-3.0, -1.2, 0.0, 0.4, 2.9})
    for (const double pitch : {-1.4, -0.3, 0.0, 1.1}) {
      // R_world_sensor = Ry(pitch) Rx(roll); the sensor measures Rᵀ (0, 0, g).
      const Mat<3, 3> R = rotation_by({0.0, pitch, 0.0}) * rotation_by({roll, 0.0, 0.0});
      const TiltAngles angles = angles_of(R.transpose() * Mat<3>(0.0, 0.0, g), small);
      EXPECT_NEAR(angles.roll_rad->value, roll, 1e-12);
      EXPECT_NEAR(angles.pitch_rad->value, pitch, 1e-12);
    }
}

TEST(TiltAngles, HaveTheStandardDeviationsOfTheirDerivatives) {
  const Mat<3> f = force_at(0.7, -0.5);
  const Mat<3, 3> cov = Mat<3>(1e-4, 4e-4, 9e-4).asDiagonal();
  Mat<3> roll, pitch;
  for (int i = 0; i < 3; ++i) {
    const Mat<3> h = 1e-5 * Mat<3>::Unit(i);
    const TiltAngles up = angles_of(f + h, cov), down = angles_of(f - h, cov);
    roll(i) = (up.roll_rad->value - down.roll_rad->value) / 2e-5;
    pitch(i) = (up.pitch_rad->value - down.pitch_rad->value) / 2e-5;
  }
  const TiltAngles angles = angles_of(f, cov);
  EXPECT_NEAR(angles.roll_rad->std, std::sqrt(roll.dot(cov * roll)), 1e-8);
  EXPECT_NEAR(angles.pitch_rad->std, std::sqrt(pitch.dot(cov * pitch)), 1e-8);
}

TEST(TiltAngles, HaveAPitchButNoRollIfTheXAxisIsVertical) {
  for (const double x : {g, -g}) {
    const TiltAngles angles = angles_of({x, 0.0, 0.0}, small);
    EXPECT_FALSE(angles.roll_rad);
    EXPECT_NE(angles.why_no_roll.find("vertical"), std::string::npos);
    ASSERT_TRUE(angles.pitch_rad);
    EXPECT_NEAR(angles.pitch_rad->value, x > 0.0 ? -std::numbers::pi / 2 : std::numbers::pi / 2,
                1e-12);
    EXPECT_NEAR(angles.pitch_rad->std, 1e-3 / g, 1e-9);
  }
}

TEST(TiltAngles, OfOneAxisAreItsElevation) {
  const TiltAngles x = angles_of_some({-g * std::sin(0.3), none, none}, small, {g, 0.0});
  EXPECT_NEAR(x.pitch_rad->value, 0.3, 1e-12);
  EXPECT_NEAR(x.pitch_rad->std, 1e-3 / (g * std::cos(0.3)), 1e-12);
  EXPECT_FALSE(x.roll_rad);
  EXPECT_FALSE(x.why_no_roll.empty());
  const TiltAngles z = angles_of_some({none, none, 9.0}, small, {g, 0.0});
  EXPECT_FALSE(z.roll_rad || z.pitch_rad);
  EXPECT_NEAR(z.elevation_rad[2]->value, std::asin(9.0 / g), 1e-12);
}

TEST(TiltAngles, OfTwoAxesAreThoseThatTheyDetermine) {
  const Mat<3> f = force_at(0.4, -0.2);
  const TiltAngles xy = angles_of_some({f.x(), f.y(), none}, small, {g, 0.0});
  EXPECT_NEAR(xy.pitch_rad->value, -0.2, 1e-12);
  EXPECT_NEAR(xy.roll_rad->value, 0.4, 1e-12);
  const TiltAngles yz = angles_of_some({none, f.y(), f.z()}, small, {g, 0.0});
  EXPECT_NEAR(yz.roll_rad->value, 0.4, 1e-12);
  EXPECT_NE(yz.why_no_pitch.find("11.5 degrees"), std::string::npos) << yz.why_no_pitch;
  const TiltAngles xz = angles_of_some({f.x(), none, f.z()}, small, {g, 0.0});
  EXPECT_NEAR(xz.pitch_rad->value, -0.2, 1e-12);
  EXPECT_NE(xz.why_no_roll.find("22.9 degrees"), std::string::npos) << xz.why_no_roll;
}

TEST(TiltAngles, OfAnAxisThatReadsMoreThanGravityAreAbsentWithAReason) {
  const TiltAngles angles = angles_of_some({9.9, none, none}, small, {g, 0.0});
  EXPECT_FALSE(angles.pitch_rad);
  EXPECT_NE(angles.why_no_pitch.find("vertical"), std::string::npos);
}

TEST(CalibrationSpread, IsThatOfTheForceByDifferencesOfEachParameter) {
  sensor::Calibration calibration;
  calibration.bias = sensor::make_axis_figures({0.1, -0.2, 0.3}, "m/s^2", "test");
  calibration.scale = sensor::make_axis_figures({1.02, 0.97, 1.01}, "1", "test");
  calibration.misalignment = sensor::make_axis_figures({0.02, -0.03, 0.01}, "rad", "test");
  const auto force = [](const std::array<double, 9>& p, const Mat<3>& reading) {
    Mat<3, 3> T = Mat<3, 3>::Identity();
    T(0, 1) = -p[6];
    T(0, 2) = p[7];
    T(1, 2) = -p[8];
    Mat<3> u;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      u(i) = (reading(i) - p[k]) / p[3 + k];
    }
    return Mat<3>(T * u);
  };
  const std::array<double, 9> p{0.1, -0.2, 0.3, 1.02, 0.97, 1.01, 0.02, -0.03, 0.01};
  const Mat<3> reading(3.0, -5.0, 8.0);
  Mat<9, 9> cov = Mat<9, 9>::Zero();
  Random random(1, "covariance");
  Mat<9, 9> root;
  for (int i = 0; i < 81; ++i) root(i) = 1e-3 * random.normal();
  cov = root * root.transpose();
  calibration.covariance.emplace();
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      (*calibration.covariance)[i][j] =
          cov(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  Mat<3, 9> J;
  for (std::size_t i = 0; i < 9; ++i) {
    auto up = p, down = p;
    up[i] += 1e-5;
    down[i] -= 1e-5;
    J.col(static_cast<Eigen::Index>(i)) = (force(up, reading) - force(down, reading)) / 2e-5;
  }
  const Mat<3, 3> expected = J * cov * J.transpose();
  const auto spread = CalibrationSpread::of(calibration);
  ASSERT_TRUE(spread);
  EXPECT_NEAR((spread->at(force(p, reading)) - expected).norm(), 0.0, 1e-8 * expected.norm());
}

TEST(CalibrationSpread, IsAbsentWhereNoFigureHasAStandardDeviation) {
  EXPECT_FALSE(CalibrationSpread::of({}));
}

TEST(TiltAngles, InclinationIsThatOfTheAxisNearestToTheVertical) {
  const Mat<3, 3> cov = 1e-4 * Mat<3, 3>::Identity();
  const TiltAngles leaning = angles_of({-9.7, 0.3, -0.4}, cov);
  ASSERT_TRUE(leaning.inclination.has_value());
  EXPECT_EQ(leaning.inclination->axis, 0U);
  EXPECT_FALSE(leaning.inclination->up);
  EXPECT_NEAR(leaning.inclination->angle_rad.value, std::atan2(0.5, 9.7), 1e-12);
  EXPECT_NEAR(leaning.inclination->angle_rad.std, 0.01 / Mat<3>(-9.7, 0.3, -0.4).norm(), 1e-9);
  EXPECT_NEAR(leaning.inclination->azimuth_rad->value, std::atan2(-0.4, 0.3), 1e-12);
  EXPECT_NEAR(leaning.inclination->azimuth_rad->std, 0.01 / 0.5, 1e-9);
  const TiltAngles upright = angles_of({0.0, 9.8, 0.001}, cov);
  EXPECT_EQ(upright.inclination->axis, 1U);
  EXPECT_TRUE(upright.inclination->up);
  EXPECT_FALSE(upright.inclination->azimuth_rad.has_value());
}

}  // namespace
}  // namespace proofmass::estimate::tilt_angles_test
