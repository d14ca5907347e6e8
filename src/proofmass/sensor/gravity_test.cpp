#include "proofmass/sensor/gravity.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::sensor::gravity_test {
namespace {

TEST(Gravity, EqualsThePublishedFiguresOfTheEllipsoid) {
  // NIMA TR8350.2, table 3.4.
  EXPECT_NEAR(gravity_mps2({.latitude_rad = 0.0}), 9.7803253359, 1e-10);
  EXPECT_NEAR(gravity_mps2({.latitude_rad = 90.0 * rad_per_deg}), 9.8321849378, 1e-9);
  EXPECT_NEAR(gravity_mps2({.latitude_rad = -90.0 * rad_per_deg}), 9.8321849378, 1e-9);
}

// The mean over the ellipsoid's surface is published too, and depends on all latitudes.
TEST(Gravity, AveragesToThePublishedMean) {
  constexpr double e2 = 0.00669437999014;
  constexpr int steps = 20000;
  double weighted = 0.0, area = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double latitude = (i + 0.5) / steps * std::numbers::pi / 2.0;
    const double sine = std::sin(latitude);
    const double zone = std::cos(latitude) / std::pow(1.0 - e2 * sine * sine, 2);
    weighted += zone * gravity_mps2({.latitude_rad = latitude});
    area += zone;
  }
  EXPECT_NEAR(weighted / area, 9.7976432222, 1e-8);
}

// Second computation: above the equator, from the zonal harmonics of the ellipsoid's potential,
// U = GM/r (1 − Σ J_2n (a/r)^2n P_2n(0)) + ω² r²/2, differentiated.
TEST(Gravity, FallsWithHeightAsTheZonalHarmonicsSay) {
  constexpr double GM = 3.986004418e14, a = 6378137.0, omega = 7.292115e-5;
  constexpr double J2 = 1.082629821313e-3, J4 = -2.37091221865e-6, J6 = 6.08346525888e-9;
  for (const double height : {0.0, 1000.0, 5000.0, 10000.0}) {
    const double r = a + height, q = (a / r) * (a / r);
    const double series =
        1.0 + 3.0 * J2 * q * 0.5 - 5.0 * J4 * q * q * 0.375 + 7.0 * J6 * q * q * q * 0.3125;
    const double expected = GM / (r * r) * series - omega * omega * r;
    EXPECT_NEAR(gravity_mps2({.height_m = height}), expected, 1e-9 + 2e-10 * height) << height;
  }
}

}  // namespace
}  // namespace proofmass::sensor::gravity_test
