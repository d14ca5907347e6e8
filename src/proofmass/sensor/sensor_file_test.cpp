#include "proofmass/sensor/sensor_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include "proofmass/sensor/file/change.hpp"

namespace proofmass::sensor::sensor_file_test {
namespace {

constexpr std::string_view written_by_hand = R"toml(# a bench's notes
[sensor]
name = "ADXL335 at the rim"
serial = "A-17"
date = 2010-03-05

[electrical]
supply = { value = 3.3, std = 0.01, unit = "V", origin = "multimeter" }
sensitivity = { value = [330, 331.5, 329], std = 2, unit = "mV/g", origin = "tumble" }
bandwidth = { value = 50, unit = "Hz" }

[noise]
white = [ { value = 106, unit = "ug/sqrt(Hz)" }, {}, { value = 212, std = 3, unit = "ug/rtHz" } ]
)toml";

SensorModel full_model() {
  SensorModel model;
  model.name = "rim \"A\" \\ π\n";
  model.serial = "17";
  model.date = "2010-03-05";
  model.electrical.supply_channel = "supply";
  const AxisFigures thirds = make_axis_figures({1.0 / 3.0, 0.1, -1e-300}, "m/s^2", "a test");
  model.electrical.lsb = make_figure(1.0 / 16384.0, "g", "range / 2^15");
  model.electrical.sensitivity = make_axis_figures({330, 331, 332}, "mV/g", "");
  model.calibration.bias = thirds;
  for (std::size_t axis = 0; axis < 3; ++axis)
    model.calibration.bias[axis]->std = 0.1 + 0.2 * static_cast<double>(axis);
  model.calibration.scale = make_axis_figures({1.1, 0.9, 1.0}, "1", "fit");
  model.calibration.temperature = make_figure(23.4, "degC", "");
  auto& covariance = model.calibration.covariance.emplace();
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j)
      covariance[i][j] = std::sqrt(static_cast<double>((i + 1) * (j + 1))) * 1e-9;
  model.noise.flicker = thirds;
  model.noise.flicker[1].reset();
  model.noise.random_walk[2] = make_figure(1e-6, "m/s^2/sqrt(s)", "noise");
  model.drift.time_constant = make_axis_figures({70, 71, 72}, "s", "warm-up");
  return model;
}

std::string error_of(std::string_view text) {
  const auto file = parse_sensor_file(text, "sensor.toml");
  return file ? "no error" : file.error().message;
}

TEST(SensorFile, ReadsWhatAPersonWrites) {
  const SensorModel model = parse_sensor_file(written_by_hand, "s.toml").value().model;
  EXPECT_EQ(model.name, "ADXL335 at the rim");
  EXPECT_EQ(model.date, "2010-03-05");
  EXPECT_EQ(model.electrical.supply->std, 0.01);
  EXPECT_EQ(model.electrical.supply->origin, "multimeter");
  EXPECT_EQ(model.electrical.sensitivity[1]->value, 331.5);
  EXPECT_EQ(model.electrical.sensitivity[2]->std, 2.0);
  EXPECT_DOUBLE_EQ(model.electrical.sensitivity[0]->si(), 0.330 / standard_gravity_mps2);
  EXPECT_EQ(model.electrical.bandwidth[2]->si(), 50.0);
  EXPECT_FALSE(model.electrical.bandwidth[2]->std);
  EXPECT_DOUBLE_EQ(model.noise.white[0]->si(), 106e-6 * standard_gravity_mps2);
  EXPECT_FALSE(model.noise.white[1]);
  EXPECT_EQ(model.noise.white[2]->std, 3.0);
}

TEST(SensorFile, ComesBackBitForBit) {
  for (const SensorModel& model :
       {full_model(), parse_sensor_file(written_by_hand, "s.toml").value().model, SensorModel{}}) {
    const std::string text = format_sensor_file(model);
    const auto back = parse_sensor_file(text, "s.toml");
    ASSERT_TRUE(back) << back.error().message << "\n" << text;
    EXPECT_EQ(back->model, model) << text;
    EXPECT_TRUE(back->notes.empty());
  }
}

TEST(SensorFile, KeepsAndNamesWhatItDoesNotKnow) {
  constexpr std::string_view text = R"toml(format = 7
[sensor]
name = "x"
colour = "green"
[noise]
spectrum = [ { f = 1.5, a = [1, 2] }, { f = 2.0, a = [] } ]
[temperature]
"odd key" = { poly = [0.1, 0.2] }
since = 2020-01-02T03:04:05Z
[temperature.deep]
on = true
)toml";
  const auto file = parse_sensor_file(text, "s.toml");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->notes.size(), 4U);
  EXPECT_EQ(file->notes[1].text,
            "s.toml: line 6: noise.spectrum is not known to this version; kept, not used");
  const std::string once = format_sensor_file(file->model);
  const auto again = parse_sensor_file(once, "s.toml");
  ASSERT_TRUE(again) << again.error().message << "\n" << once;
  EXPECT_EQ(again->model, file->model);
  for (const char* piece :
       {"format = 7", "colour = ", "poly", "0.2", "deep", "2020-01-02T03:04:05Z"})
    EXPECT_NE(once.find(piece), std::string::npos) << piece << "\n" << once;
}

TEST(SensorFile, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(error_of("[noise]\n\nwhite = { value = 1, unit = \"V\" }"),
            "sensor.toml: line 3: noise.white: cannot be in \"V\"; expected m/s^2/sqrt(Hz) or a "
            "multiple of it");
  EXPECT_EQ(error_of("[noise]\nwhite = { value = 1 }"),
            "sensor.toml: line 2: noise.white: has no unit; expected m/s^2/sqrt(Hz)");
  EXPECT_EQ(error_of("[drift]\nT = { value = nan, unit = \"s\" }"),
            "sensor.toml: line 2: drift.T.value: must be a finite number");
  EXPECT_EQ(error_of("[drift]\nT = { value = true, unit = \"s\" }"),
            "sensor.toml: line 2: drift.T.value: must be a finite number");
  EXPECT_EQ(error_of("noise = 1"), "sensor.toml: line 1: noise: must be a section, [noise]");
  EXPECT_EQ(error_of("[sensor]\nname = 3"),
            "sensor.toml: line 2: sensor.name: must be a text in quotes");
}

TEST(SensorFile, RefusesWhatCannotBeAFigure) {
  for (const char* text :
       {"[noise]\nwhite = 1.0", "[noise]\nwhite = {unit = \"m/s^2/sqrt(Hz)\"}",
        "[noise]\nwhite = {value = [1, 2], unit = \"m/s^2/sqrt(Hz)\"}", "[noise]\nwhite = [{}, {}]",
        "[noise]\nwhite = {value = 1, unit = \"m/s^2/sqrt(Hz)\", st = 1}",
        "[noise]\nwhite = {value = 1, std = -1, unit = \"m/s^2/sqrt(Hz)\"}",
        "[electrical]\nlsb = {value = [1, 2, 3], unit = \"V\"}", "[electrical]\nlsb = [{}, {}, {}]",
        "[calibration]\ncovariance = [[1]]", "[calibration]\ncovariance = 1"}) {
    const auto file = parse_sensor_file(text, "s.toml");
    ASSERT_FALSE(file) << text;
    EXPECT_EQ(file.error().code, Errc::corrupt);
    EXPECT_TRUE(file.error().message.starts_with("s.toml: line 2: ")) << file.error().message;
  }
}

TEST(SensorFile, RefusesACovarianceThatIsNotSymmetric) {
  std::string text = format_sensor_file(full_model());
  const auto at = text.find("covariance = [\n  [") + 18;
  const auto comma = text.find(", ", at) + 2;
  text.insert(comma, "9");
  EXPECT_NE(error_of(text).find("calibration.covariance: must be symmetric"), std::string::npos);
}

TEST(SensorFile, RefusesWhatIsNoToml) {
  const std::string message = error_of("[sensor\nname = 1");
  EXPECT_TRUE(message.starts_with("sensor.toml: line 1: no TOML: ")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_FALSE(parse_sensor_file(std::string_view("\0\xff\xfe", 3), "s.toml"));
}

TEST(SensorFile, IsWrittenToDiskAndReadBack) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("proofmass_sensor_" + std::to_string(::getpid()) + ".toml");
  ASSERT_TRUE(write_sensor_file(full_model(), path.string()));
  EXPECT_EQ(read_sensor_file(path.string()).value().model, full_model());
  std::filesystem::remove(path);
  const auto gone = read_sensor_file(path.string());
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Errc::unreadable);
  EXPECT_FALSE(write_sensor_file(full_model(), "/nowhere/at/all/sensor.toml"));
}

TEST(SensorFile, LosesNoChangeOfTwoAtOnce) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("proofmass_changed_" + std::to_string(::getpid()) + ".toml");
  constexpr int writers = 4, changes = 10;
  const auto count_up = [&] {
    for (int k = 0; k < changes; ++k)
      EXPECT_TRUE(change_sensor_file(path.string(), [](SensorModel& model) -> Status {
        model.serial = std::to_string(model.serial.empty() ? 1 : std::stoi(model.serial) + 1);
        return Done{};
      }));
  };
  std::vector<std::thread> threads;
  for (int k = 0; k < writers; ++k) threads.emplace_back(count_up);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(read_sensor_file(path.string()).value().model.serial,
            std::to_string(writers * changes));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace proofmass::sensor::sensor_file_test
