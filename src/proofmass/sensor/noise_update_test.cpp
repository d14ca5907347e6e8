#include "proofmass/sensor/noise_update.hpp"

#include <array>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "proofmass/sensor/file/folder_test_support.hpp"
#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor::noise_update_test {
namespace {

MeasuredNoise measured_x() {
  MeasuredNoise noise;
  noise.axis = 0;
  noise.white.identified = Uncertain{1.04e-3, 2e-6};
  noise.flicker = {.identified = Uncertain{5e-5, 4e-6}, .upper_95 = 6e-5};
  noise.random_walk.upper_95 = 3.1e-6;
  noise.bandwidth_hz = Uncertain{48.0, 1.5};
  noise.lsb = make_figure(0.3, "mV", "smallest step");
  noise.origin = "proofmass noise static.csv, 2 h at 100 Hz";
  return noise;
}

class SensorFileUpdate : public FolderTest {};

TEST(NoiseUpdate, PutsIdentifiedFiguresWithTheirStdUnitAndOrigin) {
  SensorModel model;
  ASSERT_TRUE(update_noise(model, std::vector{measured_x()}));
  const Figure& white = *model.noise.white[0];
  EXPECT_EQ(white.si(), 1.04e-3);
  EXPECT_EQ(white.std_si(), 2e-6);
  EXPECT_EQ(white.unit.symbol, "m/s^2/sqrt(Hz)");
  EXPECT_EQ(white.origin, "proofmass noise static.csv, 2 h at 100 Hz");
  EXPECT_EQ(model.noise.flicker[0]->value, 5e-5);
  EXPECT_EQ(model.noise.flicker[0]->origin, white.origin);
  EXPECT_FALSE(model.noise.white[1]);
}

TEST(NoiseUpdate, GivesZeroAndTheBoundForWhatWasNotIdentified) {
  SensorModel model;
  ASSERT_TRUE(update_noise(model, std::vector{measured_x()}));
  const Figure& walk = *model.noise.random_walk[0];
  EXPECT_EQ(walk.value, 0.0);
  EXPECT_NEAR(*walk.std * 1.645, 3.1e-6, 1e-9);
  EXPECT_EQ(walk.origin,
            "proofmass noise static.csv, 2 h at 100 Hz: below 3.1e-06 m/s^2/sqrt(s) (95 %)");
}

TEST(NoiseUpdate, KeepsWhatTheRecordingSaysNothingOf) {
  SensorModel model;
  model.noise.ramp = make_axis_figures({1e-9, 2e-9, 3e-9}, "m/s^3", "earlier");
  model.noise.white = make_axis_figures({106, 106, 212}, "ug/sqrt(Hz)", "datasheet");
  const SensorModel before = model;
  ASSERT_TRUE(update_noise(model, std::vector{measured_x()}));
  EXPECT_EQ(model.noise.ramp, before.noise.ramp);
  EXPECT_EQ(model.noise.white[0]->unit.symbol, "m/s^2/sqrt(Hz)");
  EXPECT_EQ(model.noise.white[1], before.noise.white[1]);
  EXPECT_EQ(model.noise.white[2], before.noise.white[2]);
}

TEST(NoiseUpdate, SetsBandwidthAndLsbOnlyWhereThereIsNone) {
  SensorModel model;
  ASSERT_TRUE(update_noise(model, std::vector{measured_x()}));
  EXPECT_EQ(model.electrical.bandwidth[0]->value, 48.0);
  EXPECT_EQ(model.electrical.bandwidth[0]->std, 1.5);
  EXPECT_EQ(model.electrical.lsb->origin, "smallest step");
  model.electrical.bandwidth[0] = make_figure(50.0, "Hz", "capacitor");
  model.electrical.lsb = make_figure(1.0, "V", "range");
  const Electrical before = model.electrical;
  ASSERT_TRUE(update_noise(model, std::vector{measured_x()}));
  EXPECT_EQ(model.electrical, before);
}

TEST(NoiseUpdate, RefusesWhatCannotBeAFigureAndLeavesTheModelAlone) {
  const auto refused = [](auto spoil) {
    MeasuredNoise noise = measured_x();
    spoil(noise);
    SensorModel model;
    const Status status = update_noise(model, std::vector{noise});
    EXPECT_EQ(model, SensorModel{});
    return status ? std::string("no error") : status.error().message;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused([](MeasuredNoise& m) { m.ramp.identified = Uncertain{nan, 0.0}; }),
            "noise.ramp of axis x: must be a finite number with a finite standard deviation");
  EXPECT_EQ(refused([](MeasuredNoise& m) { m.white.identified = Uncertain{-1e-3, 1e-5}; }),
            "noise.white of axis x: must not be negative");
  EXPECT_EQ(refused([](MeasuredNoise& m) { m.random_walk.upper_95 = -1.0; }),
            "noise.random_walk of axis x: must not be negative");
  EXPECT_EQ(refused([](MeasuredNoise& m) { m.bandwidth_hz = Uncertain{1.0, nan}; }),
            "electrical.bandwidth: must be a finite number with a finite standard deviation");
  EXPECT_EQ(refused([](MeasuredNoise& m) { m.lsb = make_figure(1.0, "counts", ""); }).substr(0, 20),
            "electrical.lsb: is i");
  EXPECT_EQ(refused([](MeasuredNoise& m) { m.lsb->value = nan; }).substr(0, 15), "electrical.lsb:");
}

TEST(NoiseUpdate, RefusesTwoSensorsInOneFile) {
  SensorModel model;
  const Status status = update_noise(model, std::vector{measured_x(), measured_x()});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::invalid_argument);
  EXPECT_TRUE(status.error().message.starts_with("axis x is there twice"));
}

TEST_F(SensorFileUpdate, MakesAFileNamedAfterItself) {
  ASSERT_TRUE(update_sensor_file(path("rim.toml"), std::vector{measured_x()}));
  const SensorFile file = read_sensor_file(path("rim.toml")).value();
  EXPECT_EQ(file.model.name, "rim");
  EXPECT_TRUE(file.notes.empty());
  SensorModel model;
  model.name = "rim";
  ASSERT_TRUE(update_noise(model, std::vector{measured_x()}));
  EXPECT_EQ(file.model, model);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("")), {}), 1);
}

TEST_F(SensorFileUpdate, KeepsAllElseAndDoesTheSameWhenDoneTwice) {
  write("s.toml", R"toml(format = 7
[sensor]
name = "A-17"
colour = "green"
[calibration]
bias = { value = [0.1, 0.2, 0.3], std = 0.01, unit = "m/s^2", origin = "tumble" }
[noise]
white = { value = 150, unit = "ug/sqrt(Hz)" }
[temperature]
poly = [0.1, 0.2]
)toml");
  SensorModel expected = read_sensor_file(path("s.toml")).value().model;
  ASSERT_TRUE(update_noise(expected, std::vector{measured_x()}));
  ASSERT_TRUE(update_sensor_file(path("s.toml"), std::vector{measured_x()}));
  const std::string once = text("s.toml");
  EXPECT_EQ(read_sensor_file(path("s.toml")).value().model, expected);
  EXPECT_EQ(expected.unknown.size(), 3U);
  ASSERT_TRUE(update_sensor_file(path("s.toml"), std::vector{measured_x()}));
  EXPECT_EQ(text("s.toml"), once);
}

TEST_F(SensorFileUpdate, LeavesAFileThatItCannotReadOrImproveAsItIs) {
  write("s.toml", "[noise]\nwhite = 1\n");
  const Status unreadable = update_sensor_file(path("s.toml"), std::vector{measured_x()});
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().code, Errc::corrupt);
  EXPECT_EQ(text("s.toml"), "[noise]\nwhite = 1\n");
  write("t.toml", "[sensor]\nname = \"t\"\n");
  const Status twice = update_sensor_file(path("t.toml"), std::vector{measured_x(), measured_x()});
  ASSERT_FALSE(twice);
  EXPECT_TRUE(twice.error().message.starts_with(path("t.toml") + ": axis x"));
  EXPECT_EQ(text("t.toml"), "[sensor]\nname = \"t\"\n");
  const Status nowhere = update_sensor_file(path("no/such/folder.toml"), std::vector{measured_x()});
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Errc::unwritable);
}

}  // namespace
}  // namespace proofmass::sensor::noise_update_test
