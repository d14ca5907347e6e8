#include "proofmass/sensor/datasheet.hpp"

#include <gtest/gtest.h>

#include "proofmass/sensor/grades.hpp"

namespace proofmass::sensor::datasheet_test {
namespace {

constexpr double g = standard_gravity_mps2;

// The table "Filter capacitor selection" of the datasheet, which rounds to 5 µF/C.
TEST(FilterBandwidth, IsThatOfTheDatasheetsCapacitors) {
  EXPECT_NEAR(filter_bandwidth_hz(adxl335, 4.7e-6), 1.0, 0.06);
  EXPECT_NEAR(filter_bandwidth_hz(adxl335, 0.47e-6), 10.0, 0.6);
  EXPECT_NEAR(filter_bandwidth_hz(adxl335, 0.10e-6), 50.0, 0.5);
  EXPECT_NEAR(filter_bandwidth_hz(adxl335, 0.05e-6), 100.0, 0.6);
  EXPECT_NEAR(filter_bandwidth_hz(adxl335, 0.01e-6), 500.0, 3.0);
}

// 0.0184 m/s² rms is the noise of the thesis's sensor after 100 Hz; 1.34 mg after 50 Hz.
TEST(FilteredNoise, IsTheThesissAt100Hz) {
  EXPECT_NEAR(filtered_noise_rms(adxl335.noise_density_mps2_rthz[0], 100.0), 0.0184, 5e-5);
  EXPECT_NEAR(filtered_noise_rms(adxl335.noise_density_mps2_rthz[0], 50.0), 1.34e-3 * g, 2e-4);
}

TEST(Adxl335, AtTheThesissSupplyHas330MillivoltsPerG) {
  EXPECT_NEAR(*adxl335.sensitivity_v_per_mps2.typ * 3.3 / adxl335.reference_supply_v, 0.330 / g,
              1e-12);
}

TEST(Usb6009, ResolvesTheSensorsNoise) {
  const double lsb = lsb_v(usb6009.ranges_differential_v[5], usb6009.bits_differential);
  EXPECT_DOUBLE_EQ(lsb, 10.0 / 16384.0);
  EXPECT_LT(lsb / (0.330 / g), 0.0184);
}

TEST(Grades, AreThoseOfTheThesis) {
  EXPECT_DOUBLE_EQ(grades[0].bias_mps2, 0.000025 * g);
  EXPECT_DOUBLE_EQ(grades[1].bias_mps2, 0.0003 * g);
  EXPECT_DOUBLE_EQ(grades[2].bias_mps2, 0.003 * g);
  EXPECT_DOUBLE_EQ(grades[3].bias_mps2, 0.125 * g);
}

// 0.005 °/s/√Hz is 0.3 °/√h if it is taken as two-sided, which is √2 too much.
TEST(AngleRandomWalk, OfAOneSidedDensityIsSmallerByRootTwo) {
  const double deg_rth = angle_random_walk(mpu6050.noise_density_radps_rthz) * deg_per_rad * 60.0;
  EXPECT_NEAR(deg_rth, 0.2121320343559643, 1e-12);
}

}  // namespace
}  // namespace proofmass::sensor::datasheet_test
