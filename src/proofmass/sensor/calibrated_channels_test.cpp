#include "proofmass/sensor/calibrated_channels.hpp"

#include <gtest/gtest.h>

namespace proofmass::sensor::calibrated_channels_test {
namespace {

Recording recording_in(const char* unit, std::vector<double> x) {
  Recording recording;
  recording.source = "a.csv";
  const std::vector<double> zeros(x.size(), 0.0);
  recording.channels = {{"acc_x", *parse_unit(unit), std::move(x)},
                        {"acc_y", *parse_unit(unit), zeros},
                        {"acc_z", *parse_unit(unit), zeros},
                        {"gyro_z", *parse_unit("deg/s"), zeros},
                        {"pressure", *parse_unit("Pa"), zeros}};
  return recording;
}

/// f = (reading − 1) / 2 on x.
SensorModel model() {
  SensorModel made;
  made.calibration.bias = make_axis_figures({1.0, 0.0, 0.0}, "m/s^2", "test");
  made.calibration.scale = make_axis_figures({2.0, 1.0, 1.0}, "1", "test");
  return made;
}

TEST(Accelerometers, AreNamedByTheirFileAndWhereItHasSeveralByTheirChannels) {
  Recording two = recording_in("g", {});
  two.source = "b.csv";
  for (const char* name : {"acc2_x", "acc2_y", "acc2_z"})
    two.channels.push_back({name, *parse_unit("g"), {}});
  const auto found = accelerometers({recording_in("g", {}), two}).value();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "a.csv");
  EXPECT_EQ(found[2].name, "b.csv: acc2");
  EXPECT_EQ(found[2].recording, 1U);
}

TEST(Accelerometers, TakeALoneAccelerationForXButNoMagnitude) {
  Recording lone;
  lone.channels = {{"acceleration", *parse_unit("g"), {}}};
  EXPECT_EQ(accelerometers({lone}).value().front().triad.x, 0U);
  lone.channels.front().name = "Absolute acceleration";
  EXPECT_EQ(accelerometers({lone}).error().code, Errc::invalid_argument);
}

TEST(ApplyToAccelerometers, AppliesTheModelAndBringsTheChannelsToSi) {
  std::vector<Recording> recordings{recording_in("m/s^2", {5.0, 7.0})};
  const auto found = accelerometers(recordings).value();
  ASSERT_TRUE(apply({model()}, found, recordings));
  EXPECT_EQ(recordings[0].channels[0].values, (std::vector<double>{2.0, 3.0}));
  std::vector<Recording> in_g{recording_in("g", {2.0})};
  ASSERT_TRUE(apply({}, found, in_g));
  EXPECT_DOUBLE_EQ(in_g[0].channels[0].values[0], 2.0 * 9.80665);
  EXPECT_EQ(in_g[0].channels[0].unit.symbol, "m/s^2");
}

TEST(ApplyToAccelerometers, RefusesVoltsWithoutAModelAndAWrongNumberOfModels) {
  std::vector<Recording> volts{recording_in("V", {1.0})};
  const auto found = accelerometers(volts).value();
  EXPECT_EQ(apply({}, found, volts).error().message,
            "a.csv: channel acc_x: expected an acceleration, but it is in V");
  EXPECT_EQ(apply({model(), model()}, found, volts).error().code, Errc::invalid_argument);
}

TEST(CalibratedBlocks, AreThoseOfTheWholeRecordingBlockByBlock) {
  const Recording head = recording_in("m/s^2", {});
  CalibratedBlocks blocks = CalibratedBlocks::make(head, {0, 1, 2, 3}, {model()}).value();
  ASSERT_EQ(blocks.head().channels.size(), 4U);
  EXPECT_EQ(blocks.head().channels[3].unit.symbol, "rad/s");
  const std::vector<double> zeros(2, 0.0), rates_degps(2, 180.0);
  for (const double first : {5.0, 9.0}) {
    const std::vector<double> x{first, first + 2.0};
    const Block block =
        blocks.apply({.first = 7, .channels = {x, zeros, zeros, rates_degps, zeros}}).value();
    ASSERT_EQ(block.channels.size(), 4U);
    EXPECT_EQ(block.first, 7U);
    EXPECT_EQ(block.channels[0][0], (first - 1.0) / 2.0);
    EXPECT_EQ(block.channels[0][1], (first + 1.0) / 2.0);
    EXPECT_NEAR(block.channels[3][0], 3.14159265358979, 1e-14);
  }
}

/// An accelerometer and a gyroscope whose headings have this unit, or none.
Recording with_gyroscope(const char* unit) {
  Recording recording = recording_in("m/s^2", {});
  recording.channels.resize(3);
  for (const char* name : {"gyro_x", "gyro_y", "gyro_z"})
    recording.channels.push_back({name, parse_unit(unit).value_or(Unit{}), std::vector<double>{}});
  return recording;
}

SensorModel model_with_gyroscope(const char* unit, const char* gain) {
  SensorModel made = model();
  made.gyroscope.bias = make_axis_figures({1.0, 0.0, 0.0}, unit, "test");
  made.gyroscope.scale = make_axis_figures({4.0, 1.0, 1.0}, gain, "test");
  return made;
}

/// The first rate of blocks whose gyroscope reads 9, 0, 0.
double first_rate(CalibratedBlocks& blocks) {
  const std::vector<double> zero{0.0}, nine{9.0}, five{5.0};
  const Block block =
      blocks.apply({.channels = {five, zero, zero, nine, zero, zero}, .stamps_s = {}}).value();
  EXPECT_EQ(block.channels[0][0], 2.0);
  return block.channels[3][0];
}

TEST(CalibratedBlocks, AGyroscopeIsCalibratedByItsSectionOfTheSensorFile) {
  const Unit deg = *parse_unit("deg/s");
  const auto made = [&](const char* unit, const SensorModel& by) {
    return CalibratedBlocks::make(with_gyroscope(unit), {0, 1, 2, 3, 4, 5}, {by}).value();
  };
  CalibratedBlocks plain = made("", model());
  ASSERT_TRUE(plain.add_gyroscope(0, {3, 4, 5}, deg));
  EXPECT_EQ(plain.head().channels[3].unit.symbol, "rad/s");
  EXPECT_NEAR(first_rate(plain), 9.0 * 3.14159265358979 / 180.0, 1e-14);
  CalibratedBlocks rates = made("rad/s", model_with_gyroscope("rad/s", "1"));
  ASSERT_TRUE(rates.add_gyroscope(0, {3, 4, 5}, deg));
  EXPECT_DOUBLE_EQ(first_rate(rates), 2.0);
  EXPECT_DOUBLE_EQ(first_rate(rates), 2.0) << "in each block";
  CalibratedBlocks volts = made("", model_with_gyroscope("V", "V/(rad/s)"));
  ASSERT_TRUE(volts.add_gyroscope(0, {3, 4, 5}, deg));
  EXPECT_DOUBLE_EQ(first_rate(volts), 2.0);
  CalibratedBlocks wrong = made("rad/s", model_with_gyroscope("V", "V/(rad/s)"));
  EXPECT_EQ(wrong.add_gyroscope(0, {3, 4, 5}, deg).error().message,
            "the sensor file calibrates the gyroscope's V, and channel gyro_x is in rad/s");
}

}  // namespace
}  // namespace proofmass::sensor::calibrated_channels_test
