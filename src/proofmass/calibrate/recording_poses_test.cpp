#include "proofmass/calibrate/recording_poses.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/random.hpp"

namespace proofmass::calibrate::recording_poses_test {
namespace {

constexpr double rate_hz = 100.0;
constexpr std::size_t rest = 500, move = 200;

/// Rests at 1650, 1950 and 1350 mV with an oscillation between them.
std::vector<double> stepped(std::uint64_t seed) {
  Random random(seed, "poses");
  std::vector<double> values;
  for (const double level : {1650.0, 1950.0, 1350.0}) {
    for (std::size_t k = 0; k < rest; ++k) values.push_back(level + 0.5 * random.normal());
    for (std::size_t k = 0; k < move; ++k)
      values.push_back(level + 200.0 * std::sin(0.1 * static_cast<double>(k)));
  }
  return values;
}

Recording turned(const char* unit = "mV") {
  Recording recording;
  recording.time.rate_hz = rate_hz;
  recording.channels = {{"acc_x", *parse_unit(unit), stepped(1)},
                        {"acc_y", *parse_unit(unit), stepped(2)},
                        {"acc_z", *parse_unit(unit), stepped(3)}};
  return recording;
}

TEST(RecordingPoses, AreTheMeansOfTheRestsInSiWithTheirTimes) {
  const RecordingPoses found = recording_poses(turned()).value();
  EXPECT_EQ(found.unit.symbol, "V");
  ASSERT_EQ(found.means.poses.size(), 3U);
  const double levels_v[] = {1.650, 1.950, 1.350};
  for (std::size_t k = 0; k < 3; ++k) {
    const Pose& pose = found.means.poses[k];
    EXPECT_NEAR(pose.mean.x(), levels_v[k], 2e-4);
    const double begin_s = static_cast<double>(k * (rest + move)) / rate_hz;
    EXPECT_NEAR(pose.start_s.value(), begin_s, 0.5);
    EXPECT_NEAR(pose.end_s.value(), begin_s + rest / rate_hz, 0.5);
  }
}

TEST(RecordingPoses, TakeGivenIntervalsAsTheyAre) {
  const Recording recording = turned();
  const RecordingPoses found =
      recording_poses(recording, {.dwells = {{10, 59, "first"}, {720, 799}}}).value();
  ASSERT_EQ(found.means.poses.size(), 2U);
  double sum = 0.0;
  for (std::size_t k = 10; k <= 59; ++k) sum += recording.channels[0].values[k];
  EXPECT_NEAR(found.means.poses[0].mean.x(), 1e-3 * sum / 50.0, 1e-12);
  EXPECT_EQ(found.means.poses[0].start_s, 0.1);
}

TEST(RecordingPoses, SayWhyThereAreNone) {
  Recording two = turned();
  two.channels.pop_back();
  EXPECT_EQ(recording_poses(two).error().code, Errc::invalid_argument);
  Recording mixed = turned();
  mixed.channels[2].unit = *parse_unit("g");
  EXPECT_EQ(recording_poses(mixed).error().code, Errc::invalid_argument);
  EXPECT_EQ(recording_poses(turned("K")).error().code, Errc::invalid_argument);
  Recording moving = turned();
  for (Channel& channel : moving.channels)
    for (std::size_t k = 0; k < channel.values.size(); ++k)
      channel.values.edit()[k] = 500.0 * std::sin(0.05 * static_cast<double>(k));
  EXPECT_EQ(recording_poses(moving).error().code, Errc::not_observable);
}

TEST(OnlyAccelerometer, IsRefusedWhereThereAreTwo) {
  Recording recording;
  for (const char* name : {"acc1_x", "acc1_y", "acc1_z", "acc2_x", "acc2_y", "acc2_z"})
    recording.channels.push_back({name, *parse_unit("g"), {}});
  EXPECT_EQ(only_accelerometer(recording).error().message,
            "2 accelerometers (acc1, acc2), expected one");
}

}  // namespace
}  // namespace proofmass::calibrate::recording_poses_test
