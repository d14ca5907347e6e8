// Encodings of messages: ROS 2, ROS 1, JSON.
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/io/mcap/specimens.hpp"
#include "proofmass/io/messages/cdr_specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::mcap::messages_test {
namespace {

using namespace specimen;

constexpr std::int64_t start_ns = 1'700'000'000'123'456'789;

std::string imu_front() {
  return mcap_front("ros2") +
         mcap_schema_record(1, "sensor_msgs/msg/Imu", "ros2msg", imu_definition) +
         mcap_channel_record(1, 1, "/imu/data", "cdr");
}

Recording expect_read(const std::string& file) {
  const auto read = read_text(file);
  EXPECT_TRUE(read.has_value()) << read.error().message;
  return read ? *read : Recording{};
}

TEST(McapRos, ReadsImuMessagesInEitherByteOrder) {
  for (const bool big_endian : {false, true}) {
    std::string file = imu_front();
    for (int k = 0; k < 40; ++k)
      file += mcap_message_record(1, std::uint64_t(start_ns) + 7,
                                  imu_message(k, start_ns + k * 5'000'000, CdrWriter(big_endian)));
    const Recording read = expect_read(file + mcap_end());
    EXPECT_EQ(read.time.channel, "header_stamp");
    EXPECT_EQ(read.time.start_ns, start_ns);
    EXPECT_EQ(read.time.rate_hz, 200.0);
    const Channel* acc = read.find("linear_acceleration_x");
    ASSERT_NE(acc, nullptr);
    EXPECT_EQ(acc->unit.symbol, "m/s^2");
    EXPECT_EQ(acc->values.copy().at(39), 0.001 * 39);
    EXPECT_EQ(read.find("angular_velocity_z")->unit.symbol, "rad/s");
    EXPECT_EQ(read.find("orientation_w")->values.copy().at(5), 1.0);
    EXPECT_EQ(read.channels.size(), 10u);
    EXPECT_EQ(accelerometer_triads(read).size(), 1u);
    EXPECT_TRUE(is_noted(read, "orientation_covariance")) << notes_of(read);
  }
}

TEST(McapRos, TakesTheHostsClockWhereTheStampIsZero) {
  std::string file = imu_front();
  for (int k = 0; k < 30; ++k)
    file += mcap_message_record(1, std::uint64_t(start_ns + k * 10'000'000), imu_message(k, 0));
  const Recording read = expect_read(file + mcap_end());
  EXPECT_EQ(read.time.channel, "log_time");
  EXPECT_EQ(read.time.rate_hz, 100.0);
  EXPECT_EQ(read.time.start_ns, start_ns);
}

TEST(McapRos, TellsHowTheHostsClockGoesAgainstTheDevices) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> delay_ns(0.0, 200'000.0);
  std::string file = imu_front();
  for (int k = 0; k < 2000; ++k) {
    const double device_ns = 5e6 * k;
    const double host_ns = 2e9 + device_ns * (1.0 + 50e-6) + delay_ns(random);
    file += mcap_message_record(1, static_cast<std::uint64_t>(start_ns + std::llround(host_ns)),
                                imu_message(k, start_ns + std::llround(device_ns)));
  }
  const Recording read = expect_read(file + mcap_end());
  std::string stated;
  for (const Note& note : read.notes)
    if (note.text.find("ppm") != std::string::npos) stated = note.text;
  double ahead_s = 0.0;
  double ppm = 0.0;
  double std_ppm = 0.0;
  ASSERT_EQ(std::sscanf(stated.c_str(),
                        "the clock of the host (log_time) is ahead of the device's (header_stamp) "
                        "by %lf s on average and gains %lf ± %lf ppm",
                        &ahead_s, &ppm, &std_ppm),
            3)
      << stated;
  EXPECT_NEAR(ahead_s, 2.00025, 1e-4);
  // σ √(12 / N³) / step = 0.2 ms · √(12 / 2000³) / 5 ms
  EXPECT_NEAR(std_ppm, 1.55, 0.1);
  EXPECT_NEAR(ppm, 50.0, 4.0 * std_ppm);
}

TEST(McapRos, PassesOverMessagesThatBreakOff) {
  std::string file = imu_front();
  for (int k = 0; k < 10; ++k)
    file +=
        mcap_message_record(1, 0, k == 4 ? "\1\2\3" : imu_message(k, start_ns + k * 10'000'000));
  const Recording read = expect_read(file + mcap_end());
  EXPECT_EQ(read.samples(), 9u);
  EXPECT_TRUE(is_noted(read, "a message is skipped, the first at byte")) << notes_of(read);
}

TEST(McapRos, ReadsTheFirstVersionOfRos) {
  std::string file = mcap_front("ros1") +
                     mcap_schema_record(1, "geometry_msgs/Vector3Stamped", "ros1msg",
                                        "Header header\nVector3 vector\n===\nMSG: std_msgs/Header\n"
                                        "uint32 seq\ntime stamp\nstring frame_id\n===\n"
                                        "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\n"
                                        "float64 z\n") +
                     mcap_channel_record(4, 1, "/acc", "ros1");
  for (std::uint32_t k = 0; k < 20; ++k) {
    CdrWriter out(false, 1);
    out.put(k).put(std::uint32_t{1'600'000'000}).put(k * 20'000'000).text("");
    out.put(0.5 * k).put(-1.0).put(9.8);
    file += mcap_message_record(4, 1, out.body());
  }
  const Recording read = expect_read(file + mcap_end());
  EXPECT_EQ(read.time.rate_hz, 50.0);
  EXPECT_EQ(read.find("vector_x")->values.copy().at(19), 9.5);
  EXPECT_NE(read.find("header_seq"), nullptr);
}

TEST(McapRos, TellsSchemasThatAreNotRead) {
  const std::string file = mcap_front() +
                           mcap_schema_record(1, "sensor_msgs/msg/Imu", "ros2idl", "module x {};") +
                           mcap_channel_record(1, 1, "/imu", "cdr") +
                           mcap_message_record(1, 0, imu_message(0, 1)) + mcap_end();
  const Error error = read_text(file).error();
  EXPECT_EQ(error.code, Errc::unsupported);
  EXPECT_NE(error.message.find("ros2idl"), std::string::npos) << error.message;
}

std::string json_file(const std::vector<std::string>& messages, std::string_view schema = "") {
  std::string file = mcap_front() + mcap_schema_record(1, schema, "", "") +
                     mcap_channel_record(1, 1, "/json", "json");
  for (std::size_t k = 0; k < messages.size(); ++k)
    file += mcap_message_record(1, 1'000'000'000 + 10'000'000 * k, messages[k]);
  return file + mcap_end();
}

TEST(McapJson, MakesColumnsOfTheFirstMessagesFigures) {
  const Recording read = expect_read(json_file(
      {R"-({"acc": [1, 2.5, -3], "gyro": {"x (rad/s)": 4}, "ok": true, "name": "a", "n": null})-",
       R"-({"gyro": {"x (rad/s)": 5}, "acc": [6, 7], "further": 8, "ok": false})-",
       R"-({"acc": [9, 10, 11, 12]})-"}));
  ASSERT_EQ(read.channels.size(), 6u) << notes_of(read);
  EXPECT_EQ(read.channels[0].name, "acc_x");
  EXPECT_EQ(read.channels[2].name, "acc_z");
  EXPECT_EQ(read.find("acc_y")->values, (std::vector<double>{2.5, 7, 10}));
  EXPECT_EQ(read.find("acc_x")->values, (std::vector<double>{1, 6, 9}));
  EXPECT_TRUE(std::isnan(read.find("acc_z")->values[1]));
  EXPECT_EQ(read.find("gyro_x")->unit.symbol, "rad/s");
  EXPECT_TRUE(std::isnan(read.find("gyro_x")->values[2]));
  EXPECT_EQ(read.find("ok")->values[1], 0.0);
  EXPECT_TRUE(is_noted(read, "2 figures are skipped")) << notes_of(read);
}

TEST(McapJson, TakesStampsAsFoxgloveAndRosWriteThem) {
  const auto message = [](const char* owner, const char* part, int k) {
    return fmt::format(R"({{{0}: {{"sec": 1700000000, "{1}": {2}}}, "linear_acceleration": )"
                       R"({{"x": 1, "y": 2, "z": 9}}}})",
                       owner, part, k * 20'000'000);
  };
  for (const auto& [owner, part] : {std::pair{"\"timestamp\"", "nsec"}, {"\"stamp\"", "nanosec"}}) {
    std::vector<std::string> messages;
    for (int k = 0; k < 30; ++k) messages.push_back(message(owner, part, k));
    const Recording read = expect_read(json_file(messages, "foxglove.Imu"));
    EXPECT_EQ(read.time.rate_hz, 50.0);
    EXPECT_EQ(read.time.start_ns, 1'700'000'000'000'000'000);
    EXPECT_EQ(read.find("linear_acceleration_z")->unit.symbol, "m/s^2");
  }
}

TEST(McapJson, RefusesWhatIsNoJson) {
  EXPECT_EQ(read_text(json_file({"nonsense"})).error().code, Errc::unsupported);
  EXPECT_EQ(read_text(json_file({R"({"a": "text only"})"})).error().code, Errc::unsupported);
  const std::string deep(100'000, '[');
  EXPECT_EQ(read_text(json_file({deep})).error().code, Errc::unsupported);
  const Recording read = expect_read(json_file({"1.5", "2.5", "{", deep, "3.5"}));
  EXPECT_EQ(read.channels.at(0).values, (std::vector{1.5, 2.5, 3.5}));
  EXPECT_TRUE(is_noted(read, "2 messages are skipped")) << notes_of(read);
}

}  // namespace
}  // namespace proofmass::io::mcap::messages_test
