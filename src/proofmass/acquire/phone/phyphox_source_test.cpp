#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/acquire/network/peer_test_support.hpp"

namespace proofmass::acquire::phyphox_source_test {
namespace {

class PhyphoxSource : public PhoneSource {
 protected:
  PhyphoxSource() : PhoneSource("phyphox") {}
};

TEST_F(PhyphoxSource, FindsBothSensorsAndLosesNoRow) {
  OPEN(source, {"--rate", "500"});
  const Recording& head = (*source)->head().recording;
  ASSERT_EQ(head.channels.size(), 6U);
  EXPECT_EQ(head.channels[0].name, "accX");
  EXPECT_EQ(head.channels[0].unit.symbol, "m/s^2");
  EXPECT_EQ(head.channels[5].name, "gyrZ");
  EXPECT_EQ(head.channels[5].unit.symbol, "rad/s");
  EXPECT_TRUE((*source)->head().has_device_clock);
  const Taken taken = take_rows(**source, 600);
  EXPECT_EQ(taken.error, "");
  ASSERT_GE(taken.device_ns.size(), 600U);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
  for (std::size_t k = 0; k < taken.device_ns.size(); ++k) {
    EXPECT_EQ(taken.device_ns[k], std::llround(taken.channels[0][k] * 2e6));
    EXPECT_NEAR(taken.channels[5][k], taken.channels[0][k] + 0.5, 1e-4);
  }
}

TEST_F(PhyphoxSource, TakesUnequalBuffersAsFarAsTheShortestGoes) {
  OPEN(source, {"--rate", "500", "--unequal"});
  const Taken taken = take_rows(**source, 400);
  ASSERT_GE(taken.device_ns.size(), 400U);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
  for (std::size_t k = 0; k < taken.device_ns.size(); ++k)
    EXPECT_NEAR(taken.channels[2][k], taken.channels[0][k] + 0.2, 1e-4);
}

TEST_F(PhyphoxSource, BeginsWithWhatIsMeasuredNow) {
  OPEN(source, {"--rate", "1000", "--measuring"}, "?sensors=accelerometer");
  EXPECT_EQ((*source)->head().recording.channels.size(), 3U);
  const Taken taken = take_rows(**source, 100);
  ASSERT_GE(taken.device_ns.size(), 100U);
  EXPECT_GT(taken.channels[0].front(), 0.0);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
}

TEST_F(PhyphoxSource, FollowsAClockThatIsSetBack) {
  OPEN(source, {"--rate", "500", "--jump-at", "300", "--jump-by", "0.5"});
  const Taken taken = take_rows(**source, 900);
  ASSERT_GE(taken.device_ns.size(), 900U);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
  std::size_t descents = 0;
  for (std::size_t k = 1; k < taken.device_ns.size(); ++k)
    if (taken.device_ns[k] < taken.device_ns[k - 1]) ++descents;
  EXPECT_EQ(descents, 1U);
}

TEST_F(PhyphoxSource, FollowsAStepBackOfAFewRows) {
  OPEN(source, {"--rate", "500", "--jump-at", "200", "--jump-by", "0.03"});
  const Taken taken = take_rows(**source, 600);
  ASSERT_GE(taken.device_ns.size(), 600U);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
}

TEST_F(PhyphoxSource, TellsThatTheExperimentWasOpenedAnew) {
  OPEN(source, {"--rate", "500", "--restart-at", "250"});
  const Taken taken = take_rows(**source, 600);
  ASSERT_GE(taken.device_ns.size(), 600U);
  EXPECT_TRUE(says(taken.notes, "was reopened"));
  const auto back = std::ranges::adjacent_find(taken.device_ns, std::greater<>());
  ASSERT_NE(back, taken.device_ns.end());
  EXPECT_EQ(*(back + 1), 0) << "the new session is read from its first row on";
}

TEST_F(PhyphoxSource, GoesOnWithoutRowsWhileThePhoneHasNone) {
  OPEN(source, {"--rate", "500", "--silence-at", "50"});
  (void)take_rows(**source, 50);
  Arrival arrival;
  const auto arrived = (*source)->read(arrival, std::chrono::milliseconds(700));
  ASSERT_TRUE(arrived);
  EXPECT_EQ(*arrived, Arrived::nothing);
  EXPECT_EQ(arrival.rows(), 0U);
}

TEST_F(PhyphoxSource, AsksAgainWhereAnAnswerIsCutOff) {
  OPEN(source, {"--rate", "500", "--garbage-every", "4"});
  const Taken taken = take_rows(**source, 400);
  EXPECT_EQ(taken.error, "");
  EXPECT_TRUE(says(taken.notes, "retrying"));
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
}

TEST_F(PhyphoxSource, SaysWhatToDoWhenThePhoneIsGone) {
  OPEN(source, {"--rate", "500", "--drop-at", "100"});
  const Taken taken = take_rows(**source, 100'000);
  EXPECT_TRUE(says(taken.error, "remote access"));
}

TEST_F(PhyphoxSource, NamesWhatTheExperimentHas) {
  const auto none = open({}, "?sensors=thermometer");
  ASSERT_FALSE(none);
  EXPECT_TRUE(says(none.error().message, "accelerometer, gyroscope"));
}

TEST(PhyphoxAddress, ThatNobodyListensAtIsToldAtOnce) {
  const auto none = open_source("phyphox://127.0.0.1:1");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::device);
  EXPECT_TRUE(says(none.error().message, "Connection refused"));
}

}  // namespace
}  // namespace proofmass::acquire::phyphox_source_test
