#include "proofmass/acquire/phone/phone_stream_merge.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::acquire::sensor_merge_test {
namespace {

constexpr std::int64_t ms = 1'000'000;

struct Merged : ::testing::Test {
  PhoneStreamMerge merge{{1, 1}};
  Arrival out{};

  void SetUp() override { out.clear(2); }
  void lead(std::int64_t at_ms, double value) { merge.add(0, at_ms * ms, std::array{value}); }
  void follow(std::int64_t at_ms, double value) { merge.add(1, at_ms * ms, std::array{value}); }
};
using SensorMergeOfTwo = Merged;

TEST(PhoneStreamMerge, OfOneSensorHandsItsSamplesOn) {
  PhoneStreamMerge merge({2});
  Arrival out;
  out.clear(2);
  merge.add(0, 5, std::array{1.0, 2.0});
  merge.add(0, 4, std::array{3.0, 4.0});
  merge.take(out);
  EXPECT_EQ(out.channels, (std::vector<std::vector<double>>{{1.0, 3.0}, {2.0, 4.0}}));
  EXPECT_EQ(out.device_ns, (std::vector<std::int64_t>{5, 4}));
}

TEST_F(SensorMergeOfTwo, TakesSamplesOfTheSameInstantAsTheyAre) {
  for (int k = 0; k < 5; ++k) {
    lead(10 * k, k);
    follow(10 * k, 0.1 + k);
  }
  merge.take(out);
  EXPECT_EQ(out.channels[0], (std::vector{0.0, 1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(out.channels[1], (std::vector{0.1, 1.1, 2.1, 3.1, 4.1}));
}

TEST_F(SensorMergeOfTwo, LaysTheOtherOnTheLineBetweenItsNeighbours) {
  follow(0, 0.0);
  lead(5, 1.0);
  merge.take(out);
  EXPECT_EQ(out.rows(), 0U) << "the other has nothing after it yet";
  follow(20, 4.0);
  merge.take(out);
  ASSERT_EQ(out.rows(), 1U);
  EXPECT_EQ(out.channels[1][0], 1.0);
}

TEST_F(SensorMergeOfTwo, BeginsWhereBothHaveBegun) {
  for (int k = 0; k < 4; ++k) lead(10 * k, k);
  follow(15, 1.5);
  follow(35, 3.5);
  merge.take(out);
  EXPECT_EQ(out.channels[0], (std::vector{2.0, 3.0}));
  const auto notes = merge.take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].text, "skipped 2 samples from before all sensors had begun");
}

TEST_F(SensorMergeOfTwo, GoesOnWithoutASensorThatIsSilent) {
  lead(0, 0.0);
  follow(0, 0.0);
  for (int k = 1; k < 300; ++k) lead(10 * k, k);
  merge.take(out);
  ASSERT_EQ(out.rows(), 199U);  // all except the last second
  EXPECT_TRUE(std::isnan(out.channels[1].back()));
  EXPECT_EQ(merge.take_notes().size(), 1U);
}

TEST_F(SensorMergeOfTwo, DoesNotBridgeAHoleOfMoreThanASecond) {
  lead(0, 0.0);
  follow(0, 0.0);
  lead(500, 1.0);
  follow(1500, 1.0);
  merge.take(out);
  ASSERT_EQ(out.rows(), 2U);
  EXPECT_TRUE(std::isnan(out.channels[1][1]));
}

TEST_F(SensorMergeOfTwo, FollowsAClockThatIsSetBack) {
  for (const int start : {10'000, 3'000})
    for (int k = 0; k < 3; ++k) {
      lead(start + 10 * k, start + k);
      follow(start + 10 * k, start + k);
    }
  merge.take(out);
  ASSERT_EQ(out.rows(), 6U);
  EXPECT_EQ(out.channels[0], out.channels[1]);
}

TEST_F(SensorMergeOfTwo, IsNotSetApartByOneFalseReadingOfTheClock) {
  for (int k = 0; k < 300; ++k) {
    lead(k == 100 ? -50'000 : 10'000 + 10 * k, k);
    follow(10'000 + 10 * k, k);
    merge.take(out);
  }
  ASSERT_EQ(out.rows(), 300U);
  EXPECT_EQ(out.channels[1].back(), 299.0);
}

TEST_F(SensorMergeOfTwo, ForgetsTheOldestOfAFollowerThatWaitsForALeader) {
  constexpr int samples = 300'000, waiting = 100'000;
  for (int k = 0; k < samples; ++k) follow(k, k);
  lead(samples - waiting - 1, 1.0);
  merge.take(out);
  EXPECT_EQ(out.rows(), 0U) << "what the follower had then is forgotten";
  lead(samples - waiting, 2.0);
  merge.take(out);
  ASSERT_EQ(out.rows(), 1U);
  EXPECT_EQ(out.channels[1][0], samples - waiting);
}

TEST_F(SensorMergeOfTwo, DoesNotWaitForEverWhereTheLeadersClockStands) {
  constexpr int samples = 300'000, waiting = 100'000;
  for (int k = 0; k < samples; ++k) {
    lead(1, k);
    merge.take(out);
  }
  ASSERT_EQ(out.rows(), samples - waiting);
  EXPECT_EQ(out.channels[0].back(), samples - waiting - 1.0);
  EXPECT_TRUE(std::isnan(out.channels[1].back()));
}

}  // namespace
}  // namespace proofmass::acquire::sensor_merge_test
