// A car's wheels with two units on each, at the hub and at a radius (trials 06 and 10). The numbers
// of turns were counted from the phase of gravity by two other methods, accurate to about 0.015
// turn.
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::wheel_real_test {
namespace {

using estimate::WheelSensor;
using estimate::WheelSolution;

struct Wheel {
  const char* trial;
  const char* number;
  double hub_turns, radial_turns;
  double radial_radius_m;
};

void PrintTo(const Wheel& wheel, std::ostream* out) {
  *out << wheel.trial << " wheel " << wheel.number;
}

std::filesystem::path file_of(const Wheel& wheel, const char* place) {
  return published_data() / "wid-car-wheels" / wheel.trial /
         (std::string("IMU") + wheel.number + place + ".csv.xz");
}

std::vector<double> values_of(const Recording& recording, const char* name) {
  const Channel* channel = recording.find(name);
  EXPECT_NE(channel, nullptr) << name;
  std::vector<double> out;
  if (channel != nullptr)
    for (const double value : channel->values) out.push_back(channel->unit.si(value));
  return out;
}

/// The file's accelerometer on its own clock, seconds from `origin_ns`.
WheelSensor sensor_of(const std::filesystem::path& file, std::int64_t origin_ns) {
  const Recording recording = io::read_recording(file.string(), {}).value();
  WheelSensor sensor;
  sensor.name = file.stem().stem().string();
  const double begin_s =
      1e-9 * static_cast<double>(recording.time.start_ns.value_or(0) - origin_ns);
  for (std::size_t k = 0; k < recording.samples(); ++k)
    sensor.time_s.push_back(begin_s + recording.time.at(k));
  const std::array names{"Acc_X", "Acc_Y", "Acc_Z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Channel* channel = recording.find(names[axis]);
    EXPECT_NE(channel, nullptr) << file << " has no " << names[axis];
    if (channel != nullptr) sensor.accel_mps2[axis] = channel->values.copy();
  }
  return sensor;
}

std::int64_t start_of(const std::filesystem::path& file) {
  return io::read_recording(file.string(), {}).value().time.start_ns.value_or(0);
}

WheelSolution solve(const std::vector<WheelSensor>& sensors) {
  auto solution = estimate::estimate_wheel(sensors, {});
  EXPECT_TRUE(solution.has_value()) << solution.error().message;
  EXPECT_TRUE(solution->turns.has_value());
  return std::move(solution).value();
}

class CarWheel : public testing::TestWithParam<Wheel> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(file_of(GetParam(), "")))
      GTEST_SKIP() << absent(file_of(GetParam(), ""));
    origin_ns_ = start_of(file_of(GetParam(), ""));
  }
  [[nodiscard]] WheelSensor hub() const { return sensor_of(file_of(GetParam(), ""), origin_ns_); }
  [[nodiscard]] WheelSensor radial() const {
    return sensor_of(file_of(GetParam(), "_radial"), origin_ns_);
  }
  [[nodiscard]] bool negative() const { return GetParam().hub_turns < 0.0; }

 private:
  std::int64_t origin_ns_ = 0;
};

TEST_P(CarWheel, TurnsAsTheFiguresOfOtherMethodsSay) {
  EXPECT_NEAR(solve({hub()}).turns->value, GetParam().hub_turns, 0.02);
  EXPECT_NEAR(solve({radial()}).turns->value, GetParam().radial_turns, 0.02);
}

TEST_P(CarWheel, ItsTwoUnitsAgreeAsWellAsTheySay) {
  const auto hub_turns = solve({hub()}).turns, radial_turns = solve({radial()}).turns;
  const double difference = std::abs(hub_turns->value - radial_turns->value);
  EXPECT_LT(difference, 0.005);
  EXPECT_LT(difference, 3.0 * std::hypot(hub_turns->std, radial_turns->std));
}

TEST_P(CarWheel, ThePairIsConsistentWithEachUnit) {
  const auto pair = solve({hub(), radial()}).turns;
  for (const WheelSensor& sensor : {hub(), radial()}) {
    const auto alone = solve({sensor}).turns;
    EXPECT_LT(std::abs(pair->value - alone->value), 3.0 * std::hypot(pair->std, alone->std))
        << sensor.name;
  }
}

TEST_P(CarWheel, TheRadialUnitSitsWhereItWasMounted) {
  const auto solution = solve({radial()});
  const auto& radius = solution.sensors[0].radius_m;
  ASSERT_TRUE(radius.has_value());
  EXPECT_NEAR(radius->value, GetParam().radial_radius_m, 0.003);
}

// The rolling circumference from the length of the path by GNSS in trial 10, 190.5 m in 105.41
// turns, which is good to some per cent.
TEST_P(CarWheel, TheGyroscopeShowsItsRollingRadius) {
  WheelSensor sensor = hub();
  const Recording recording = io::read_recording(file_of(GetParam(), "").string(), {}).value();
  sensor.rate_radps = {values_of(recording, "Gyr_X"), values_of(recording, "Gyr_Y"),
                       values_of(recording, "Gyr_Z")};
  const auto solution = solve({sensor});
  EXPECT_NEAR(solution.turns->value, GetParam().hub_turns, 0.02);
  ASSERT_TRUE(solution.rolling_radius_m);
  const Uncertain& radius_m = *solution.rolling_radius_m;
  EXPECT_NEAR(radius_m.value, 0.288, 3.0 * std::hypot(radius_m.std, 0.01));
  EXPECT_LT(radius_m.std, 0.04);
}

TEST_P(CarWheel, CorruptRowsAreCountedAndDoNotMoveTheTurns) {
  const WheelSensor clean = radial();
  WheelSensor dirty = clean;
  const std::array values{std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity(), 3e34, 1e-40};
  std::size_t spoilt = 0;
  for (std::size_t row = 50; row < dirty.time_s.size(); row += 100, ++spoilt)
    for (auto& axis : dirty.accel_mps2) axis[row] = values[spoilt % values.size()];
  const auto expected = solve({clean}), solution = solve({dirty});
  EXPECT_NEAR(solution.turns->value, expected.turns->value, 0.005);
  EXPECT_EQ(solution.sensors[0].unusable, expected.sensors[0].unusable + spoilt);
  std::size_t named = 0;
  for (const auto& stretch : solution.rejected)
    if (stretch.reason.starts_with(clean.name)) named += stretch.rows;
  EXPECT_EQ(named, solution.sensors[0].unusable);
  for (const double angle : solution.series.angle_rad) ASSERT_TRUE(std::isfinite(angle));
}

INSTANTIATE_TEST_SUITE_P(Trials,
                         CarWheel,
                         testing::Values(Wheel{"trial06", "1", -79.615, -79.613, 0.143},
                                         Wheel{"trial06", "2", -78.215, -78.216, 0.153},
                                         Wheel{"trial06", "3", 79.924, 79.924, 0.165},
                                         Wheel{"trial10", "1", -105.411, -105.411, 0.143}));

/// The right wheel of a wheelchair pushed by hand: 19.32 ± 0.02 turns, the fraction from the
/// direction of gravity at both ends and the whole turns from the gyroscope.
TEST(Wheelchair, TurnsAsGravityAndTheGyroscopeSayWithItAndWithout) {
  const auto file =
      published_data() / "worklab-wheelchair" / "NGIMU - 3 Right - 003383F9" / "sensors.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Recording recording = io::read_recording(file.string(), {}).value();
  WheelSensor sensor;
  sensor.name = "right";
  for (std::size_t k = 0; k < recording.samples(); ++k)
    sensor.time_s.push_back(recording.time.at(k));
  const auto values = [&](const char* name) { return values_of(recording, name); };
  sensor.accel_mps2 = {values("Accelerometer X"), values("Accelerometer Y"),
                       values("Accelerometer Z")};
  const auto alone = solve({sensor});
  sensor.rate_radps = {values("Gyroscope X"), values("Gyroscope Y"), values("Gyroscope Z")};
  const auto with_gyro = solve({sensor});
  for (const auto* solution : {&alone, &with_gyro}) {
    EXPECT_NEAR(solution->turns->value, 19.32, 3.0 * std::hypot(solution->turns->std, 0.02));
    EXPECT_LT(solution->turns->std, 0.1);
  }
  EXPECT_NEAR(with_gyro.sensors[0].gyro_scale->value, 1.0, 0.03);
  // Wheels of 24 inches.
  ASSERT_TRUE(with_gyro.rolling_radius_m);
  EXPECT_NEAR(with_gyro.rolling_radius_m->value, 0.305, 3.0 * with_gyro.rolling_radius_m->std);
  EXPECT_LT(with_gyro.rolling_radius_m->std, 0.05);
  // At 30 s the chair turns on the spot, with a camber of 18°: gravity alone and with the
  // gyroscope.
  for (std::size_t k = 0; k < with_gyro.series.time_s.size(); k += 100)
    ASSERT_NEAR(with_gyro.series.angle_rad[k], alone.series.angle_rad[k], 0.2)
        << with_gyro.series.time_s[k];
}

}  // namespace
}  // namespace proofmass::wheel_real_test
