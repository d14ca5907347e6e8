#include "proofmass/sensor/drift_update.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "proofmass/sensor/file/folder_test_support.hpp"
#include "proofmass/sensor/noise_update.hpp"
#include "proofmass/sensor/sensor_file.hpp"
#include "proofmass/sensor/warm_up.hpp"

namespace proofmass::sensor::drift_update_test {
namespace {

MeasuredDrift measured_y() {
  return {.axis = 1,
          .a1_mps2 = {-0.05, 0.001},
          .a2_mps2 = {9.81, 0.0005},
          .time_constant_s = {900.0, 20.0},
          .origin = "proofmass drift static.csv, 2 h at 100 Hz"};
}

class DriftFileUpdate : public FolderTest {};

TEST(DriftUpdate, PutsTheFiguresWithTheirStdUnitAndOrigin) {
  SensorModel model;
  ASSERT_TRUE(update_drift(model, std::vector{measured_y()}));
  EXPECT_EQ(model.drift.a1[1]->si(), -0.05);
  EXPECT_EQ(model.drift.a1[1]->std_si(), 0.001);
  EXPECT_EQ(model.drift.a2[1]->si(), 9.81);
  EXPECT_EQ(model.drift.a2[1]->std_si(), 0.0005);
  EXPECT_EQ(model.drift.time_constant[1]->si(), 900.0);
  EXPECT_EQ(model.drift.time_constant[1]->std_si(), 20.0);
  for (const AxisFigures& figures : {model.drift.a1, model.drift.a2, model.drift.time_constant}) {
    EXPECT_EQ(figures[1]->origin, "proofmass drift static.csv, 2 h at 100 Hz");
    EXPECT_FALSE(figures[0] || figures[2]);
  }
}

TEST(DriftUpdate, KeepsTheAxesThatWereNotIdentified) {
  SensorModel model;
  model.drift.a1 = make_axis_figures({1, 2, 3}, "mg", "earlier");
  const DriftModel before = model.drift;
  ASSERT_TRUE(update_drift(model, std::vector{measured_y()}));
  EXPECT_EQ(model.drift.a1[0], before.a1[0]);
  EXPECT_EQ(model.drift.a1[2], before.a1[2]);
  EXPECT_EQ(model.drift.a1[1]->unit.symbol, "m/s^2");
  ASSERT_TRUE(update_drift(model, View<MeasuredDrift>{}));
  EXPECT_EQ(model.drift.a1[0], before.a1[0]);
}

TEST(DriftUpdate, RefusesWhatCannotBeAFigureAndLeavesTheModelAlone) {
  const auto refused = [](auto spoil) {
    MeasuredDrift drift = measured_y();
    spoil(drift);
    SensorModel model;
    const Status status = update_drift(model, std::vector{drift});
    EXPECT_EQ(model, SensorModel{});
    return status ? std::string("no error") : status.error().message;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused([](MeasuredDrift& m) { m.a1_mps2.value = nan; }),
            "drift.a1 of axis y: must be a finite number with a finite standard deviation");
  EXPECT_EQ(refused([](MeasuredDrift& m) { m.a2_mps2.std = nan; }),
            "drift.a2 of axis y: must be a finite number with a finite standard deviation");
  EXPECT_EQ(refused([](MeasuredDrift& m) { m.a2_mps2.std = -1.0; }),
            "drift.a2 of axis y: its standard deviation must not be negative");
  EXPECT_EQ(refused([](MeasuredDrift& m) { m.time_constant_s.value = 0.0; }),
            "drift.T of axis y: must be positive");
}

TEST(DriftUpdate, RefusesTwoSensorsInOneFile) {
  SensorModel model;
  const Status status = update_drift(model, std::vector{measured_y(), measured_y()});
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::invalid_argument);
  EXPECT_TRUE(status.error().message.starts_with("axis y is there twice"));
  EXPECT_EQ(model, SensorModel{});
}

TEST_F(DriftFileUpdate, MakesAFileThatGivesTheWarmUpBack) {
  ASSERT_TRUE(update_sensor_file(path("rim.toml"), std::vector{measured_y()}));
  const SensorFile file = read_sensor_file(path("rim.toml")).value();
  EXPECT_EQ(file.model.name, "rim");
  EXPECT_TRUE(file.notes.empty());
  const WarmUp warm_up = warm_up_of(file.model.drift, 1).value();
  EXPECT_EQ(warm_up.a1_mps2, -0.05);
  EXPECT_EQ(warm_up.a2_mps2, 9.81);
  EXPECT_EQ(warm_up.time_constant_s, 900.0);
  EXPECT_EQ(warm_up.covariance[2][2], 400.0);
}

TEST_F(DriftFileUpdate, KeepsAllElseAndDoesTheSameWhenDoneTwice) {
  write("s.toml", R"toml([sensor]
name = "A-17"
colour = "green"
[calibration]
bias = { value = [0.1, 0.2, 0.3], std = 0.01, unit = "m/s^2", origin = "tumble" }
)toml");
  MeasuredNoise noise;
  noise.white.identified = Uncertain{1e-3, 1e-5};
  ASSERT_TRUE(update_sensor_file(path("s.toml"), std::vector{noise}));
  SensorModel expected = read_sensor_file(path("s.toml")).value().model;
  ASSERT_TRUE(update_drift(expected, std::vector{measured_y()}));
  ASSERT_TRUE(update_sensor_file(path("s.toml"), std::vector{measured_y()}));
  EXPECT_EQ(read_sensor_file(path("s.toml")).value().model, expected);
  const std::string once = text("s.toml");
  ASSERT_TRUE(update_sensor_file(path("s.toml"), std::vector{measured_y()}));
  EXPECT_EQ(text("s.toml"), once);
}

TEST_F(DriftFileUpdate, LeavesAFileThatItCannotReadOrImproveAsItIs) {
  write("s.toml", "[drift]\na1 = \"much\"\n");
  const Status unreadable = update_sensor_file(path("s.toml"), std::vector{measured_y()});
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(unreadable.error().code, Errc::corrupt);
  EXPECT_EQ(text("s.toml"), "[drift]\na1 = \"much\"\n");
  write("t.toml", "[sensor]\nname = \"t\"\n");
  const Status twice = update_sensor_file(path("t.toml"), std::vector{measured_y(), measured_y()});
  ASSERT_FALSE(twice);
  EXPECT_TRUE(twice.error().message.starts_with(path("t.toml") + ": axis y"));
  EXPECT_EQ(text("t.toml"), "[sensor]\nname = \"t\"\n");
}

}  // namespace
}  // namespace proofmass::sensor::drift_update_test
