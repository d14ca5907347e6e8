#include "proofmass/sensor/parts.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "proofmass/core/units.hpp"

namespace proofmass::sensor::parts_test {
namespace {

TEST(Parts, AreTwelveAtLeastOfSeveralMakersEachWithItsSource) {
  std::set<std::string> names, makers;
  bool analog = false, digital = false;
  for (const AccelerometerPart& part : accelerometer_parts()) {
    names.insert(std::string(part.name));
    makers.insert(std::string(part.maker));
    EXPECT_FALSE(part.document.empty()) << part.name;
    EXPECT_GT(part.range_mps2, 1.4 * standard_gravity_mps2) << part.name;
    (part.output == PartOutput::analog ? analog : digital) = true;
  }
  EXPECT_EQ(names.size(), accelerometer_parts().size());
  EXPECT_GE(names.size(), 12U);
  EXPECT_GE(makers.size(), 5U);
  EXPECT_TRUE(analog && digital);
}

TEST(Parts, HaveFiguresOfTheOrderOfMems) {
  for (const AccelerometerPart& part : accelerometer_parts()) {
    if (part.noise_mps2_rthz) {
      EXPECT_GT(part.noise_mps2_rthz->value, 1e-6 * standard_gravity_mps2) << part.name;
      EXPECT_LT(part.noise_mps2_rthz->value, 1e-3 * standard_gravity_mps2) << part.name;
    }
    if (part.offset_mps2) {
      EXPECT_LE(part.offset_mps2->value, 1.01 * standard_gravity_mps2) << part.name;
    }
  }
  for (const GyroscopePart& part : gyroscope_parts()) {
    ASSERT_TRUE(part.noise_radps_rthz) << part.name;
    EXPECT_LT(part.noise_radps_rthz->value, 0.05 * rad_per_deg) << part.name;
    EXPECT_GT(part.noise_radps_rthz->value, 0.001 * rad_per_deg) << part.name;
  }
}

TEST(Parts, ALimitIsAUniformDistribution) {
  EXPECT_NEAR((PartFigure{3.0, FigureKind::limit}).std(), std::sqrt(3.0), 1e-12);
  EXPECT_EQ((PartFigure{3.0, FigureKind::typical}).std(), 3.0);
}

TEST(Parts, AreFoundHoweverTheyAreSpelled) {
  ASSERT_NE(find_part("mpu6050"), nullptr);
  EXPECT_EQ(find_part("mpu6050")->name, "MPU-6050");
  EXPECT_EQ(find_part("ADXL999"), nullptr);
}

// The zero-g level of the z axis, 1.2 to 1.8 V at 300 mV/g, is within 1 g of 1.5 V.
TEST(Parts, OfTheAdxl335HaveTheWorstAxis) {
  EXPECT_NEAR(find_part("adxl335")->offset_mps2->value, standard_gravity_mps2, 1e-9);
  EXPECT_NEAR(find_part("adxl335")->noise_mps2_rthz->value, 300e-6 * standard_gravity_mps2, 1e-12);
}

}  // namespace
}  // namespace proofmass::sensor::parts_test
