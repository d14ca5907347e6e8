#include "proofmass/sensor/gyroscope_update.hpp"

#include <gtest/gtest.h>

#include "proofmass/core/units.hpp"
#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor::gyroscope_update_test {
namespace {

MeasuredGyroscope in_counts() {
  MeasuredGyroscope out;
  out.reading_unit = "counts";
  out.origin = "proofmass calibrate turned.csv";
  auto& covariance = out.covariance.emplace();
  for (std::size_t k = 0; k < gyroscope_figures; ++k) {
    out.figures[k] = Uncertain{1.0 + static_cast<double>(k), 0.5};
    covariance[k][k] = 0.25;
  }
  return out;
}

TEST(GyroscopeUpdate, IsReadBackFromTheFileBitForBit) {
  SensorModel model;
  model.gyroscope.white = make_axis_figures({0.3, 0.3, 0.4}, "deg/sqrt(h)", "datasheet");
  ASSERT_TRUE(update_gyroscope(model, in_counts()));
  EXPECT_EQ(model.gyroscope.scale[1]->unit.si_symbol, "counts/(rad/s)");
  EXPECT_EQ(model.gyroscope.g_sensitivity[2][2]->value, 21.0);
  EXPECT_TRUE(model.gyroscope.white[0]);
  const auto read = parse_sensor_file(format_sensor_file(model), "file.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->model, model);
  EXPECT_TRUE(read->notes.empty());
}

TEST(GyroscopeUpdate, DropsWhatWasNotDeterminedAndTheCovarianceWithIt) {
  SensorModel model;
  ASSERT_TRUE(update_gyroscope(model, in_counts()));
  MeasuredGyroscope later = in_counts();
  later.figures[4].reset();
  ASSERT_TRUE(update_gyroscope(model, later));
  EXPECT_FALSE(model.gyroscope.scale[1]);
  EXPECT_FALSE(model.gyroscope.covariance);
}

TEST(GyroscopeUpdate, RefusesAScaleOfZero) {
  SensorModel model;
  MeasuredGyroscope bad = in_counts();
  bad.figures[3] = Uncertain{0.0, 0.1};
  EXPECT_FALSE(update_gyroscope(model, bad));
  EXPECT_EQ(model, SensorModel{});
}

// Units of makers: 1 °/√h is 1/60 °/s/√Hz, 1 °/h is 1/3600 °/s.
TEST(GyroscopeUnits, AreThoseOfItsMakers) {
  const auto si = [](const char* unit) { return parse_figure_unit(unit).value(); };
  EXPECT_NEAR(si("deg/sqrt(h)").to_si, rad_per_deg / 60.0, 1e-18);
  EXPECT_NEAR(si("deg/h").to_si, rad_per_deg / 3600.0, 1e-18);
  EXPECT_NEAR(si("deg/h/sqrt(h)").to_si, rad_per_deg / 216000.0, 1e-20);
  EXPECT_NEAR(si("deg/s/sqrt(Hz)").to_si, rad_per_deg, 1e-15);
  EXPECT_NEAR(si("mdps/√Hz").to_si, 1e-3 * rad_per_deg, 1e-15);
  EXPECT_NEAR(si("deg/s/g").to_si, rad_per_deg / 9.80665, 1e-15);
  EXPECT_NEAR(si("counts/(deg/s)").to_si, 57.29577951308232, 1e-9);
  EXPECT_EQ(si("counts/(deg/s)").si_symbol, "counts/(rad/s)");
}

}  // namespace
}  // namespace proofmass::sensor::gyroscope_update_test
