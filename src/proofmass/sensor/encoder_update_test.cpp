#include "proofmass/sensor/encoder_update.hpp"

#include <gtest/gtest.h>
#include <limits>

#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor::encoder_update_test {
namespace {

MeasuredEncoder measured() {
  return {4096.0, {{{3e-3, 1e-4}, {-4e-3, 2e-4}, {5e-4, 5e-5}, {0.0, 6e-5}}}, "calibrate a.csv"};
}

TEST(EncoderUpdate, WritesWhatIsReadBack) {
  SensorModel model;
  ASSERT_TRUE(update_encoder(model, measured()));
  const auto errors = encoder_errors_rad(model.encoder);
  ASSERT_TRUE(errors);
  EXPECT_DOUBLE_EQ((*errors)[1].value, -4e-3);
  EXPECT_DOUBLE_EQ((*errors)[3].std, 6e-5);
  EXPECT_DOUBLE_EQ(model.encoder.counts_per_turn->value, 4096.0);
  const auto file = parse_sensor_file(format_sensor_file(model), "wheel.toml");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_TRUE(file->model.encoder == model.encoder);
  EXPECT_TRUE(file->model.unknown.empty());
}

TEST(EncoderUpdate, RefusesWhatIsNoFigure) {
  SensorModel model;
  MeasuredEncoder broken = measured();
  broken.errors_rad[2].std = -1.0;
  EXPECT_EQ(update_encoder(model, broken).error().code, Errc::invalid_argument);
  broken.errors_rad[2].value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(update_encoder(model, broken).error().code, Errc::not_finite);
  EXPECT_FALSE(model.encoder.once_cos);
}

TEST(EncoderUpdate, AnErrorWithoutItsUncertaintyIsNotApplied) {
  SensorModel model;
  ASSERT_TRUE(update_encoder(model, measured()));
  model.encoder.twice_sin->std.reset();
  EXPECT_FALSE(encoder_errors_rad(model.encoder));
}

}  // namespace
}  // namespace proofmass::sensor::encoder_update_test
