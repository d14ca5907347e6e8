#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/acquire/network/peer_test_support.hpp"
#include "proofmass/acquire/phone/sensor_server_messages.hpp"

namespace proofmass::acquire::sensor_server_test {
namespace {

TEST(SensorMessage, HasATimeAndValues) {
  SensorMessage message;
  ASSERT_TRUE(parse_sensor_message(
      R"({"accuracy":2,"timestamp":3925657519043709,"values":[0.25,-1,10.5]})", message));
  EXPECT_EQ(message.timestamp_ns, 3925657519043709);
  EXPECT_EQ(message.accuracy, 2);
  EXPECT_EQ(message.values, (std::vector<double>{0.25, -1.0, 10.5}));
  EXPECT_EQ(message.type, "");
}

TEST(SensorMessage, RefusesWhatIsNone) {
  SensorMessage message;
  for (const char* text : {"", "{}", "[1]", R"({"timestamp":1})", R"({"timestamp":1,"values":[]})",
                           R"({"values":[1]})", R"({"timestamp":1.5,"values":[1]})",
                           R"({"timestamp":9223372036854775807,"values":[1]})"})
    EXPECT_FALSE(parse_sensor_message(text, message)) << text;
}

class SensorServerSource : public PhoneSource {
 protected:
  SensorServerSource() : PhoneSource("sensorserver") {}
};

TEST_F(SensorServerSource, HandsOutEachMessage) {
  OPEN(source, {"--rate", "500"});
  const Recording& head = (*source)->head().recording;
  ASSERT_EQ(head.channels.size(), 3U);
  EXPECT_EQ(head.channels[2].name, "acc_z");
  EXPECT_EQ(head.channels[2].unit.symbol, "m/s^2");
  const Taken taken = take_rows(**source, 500);
  ASSERT_GE(taken.device_ns.size(), 500U);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
  EXPECT_EQ(taken.channels[0].front(), 0.0) << "the message that described the sensor is a row";
  EXPECT_EQ(taken.device_ns[1] - taken.device_ns[0], 2'000'000);
}

TEST_F(SensorServerSource, LaysSeveralSensorsBesideEachOther) {
  OPEN(source, {"--rate", "500"}, "?type=accelerometer,android.sensor.gyroscope");
  const Recording& head = (*source)->head().recording;
  ASSERT_EQ(head.channels.size(), 6U);
  EXPECT_EQ(head.channels[3].name, "gyr_x");
  EXPECT_EQ(head.channels[3].unit.symbol, "rad/s");
  const Taken taken = take_rows(**source, 500);
  ASSERT_GE(taken.device_ns.size(), 500U);
  EXPECT_EQ(broken_steps(taken.channels[0]), "");
  for (std::size_t k = 0; k < taken.device_ns.size(); ++k)
    EXPECT_DOUBLE_EQ(taken.channels[5][k], taken.channels[0][k] + 0.5);
}

TEST_F(SensorServerSource, PassesOverWhatIsNoMessageAndSaysSo) {
  OPEN(source, {"--rate", "500", "--garbage-every", "50"});
  const Taken taken = take_rows(**source, 300);
  ASSERT_GE(taken.device_ns.size(), 300U);
  EXPECT_TRUE(says(taken.notes, "skipped"));
}

TEST_F(SensorServerSource, EndsWithTheReasonOfTheOtherSide) {
  OPEN(source, {"--rate", "500", "--drop-at", "200"});
  const Taken taken = take_rows(**source, 100'000);
  EXPECT_TRUE(says(taken.error, "4004: Server stopped"));
  EXPECT_EQ(taken.channels[0].back(), 199.0) << "what came before the end is handed out";
}

TEST_F(SensorServerSource, EndsWithTheReasonWhereTheOtherSideBreaksTheProtocol) {
  OPEN(source, {"--rate", "500", "--nonsense-at", "100"});
  const Taken taken = take_rows(**source, 100'000);
  EXPECT_TRUE(says(taken.error, "breaks the WebSocket protocol")) << taken.error;
}

TEST_F(SensorServerSource, IsToldWhichSensorThePhoneLacks) {
  const auto none = open({}, "?type=thermometer");
  ASSERT_FALSE(none);
  EXPECT_TRUE(says(none.error().message, "thermometer not found"));
}

TEST_F(SensorServerSource, EndsWhenThePhoneIsGone) {
  OPEN(source, {"--rate", "500"});
  (void)take_rows(**source, 10);
  peer_->end();
  EXPECT_TRUE(says(take_rows(**source, 100'000).error, "no SensorServer"));
}

}  // namespace
}  // namespace proofmass::acquire::sensor_server_test
