#include "proofmass/io/reading/channel_units.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::channel_units_test {
namespace {

/// A static three-axis accelerometer, tilted, whose measurements have the norm `gravity`.
std::string at_rest(const std::string& header, double gravity, bool whole = false) {
  std::string text = header + "\n";
  for (int k = 0; k < 300; ++k) {
    const double ripple = 1.0 + 1e-3 * std::sin(0.7 * k);
    text += std::to_string(0.01 * k);
    for (const double share : {0.6, -0.48, 0.64}) {
      const double value = gravity * share * ripple;
      text += "," + (whole ? std::to_string(std::lround(value)) : std::to_string(value));
    }
    text += "\n";
  }
  return text;
}

std::string unit_found(const std::string& text, const ReadOptions& options = {}) {
  const auto read = read_text(text, options);
  if (!read) return read.error().message;
  return read->channels.at(0).unit.symbol;
}

TEST(ChannelUnits, TellsTheUnitByGravity) {
  EXPECT_EQ(unit_found(at_rest("t (s),acc_x,acc_y,acc_z", 9.81)), "m/s^2");
  EXPECT_EQ(unit_found(at_rest("t (s),ax,ay,az", 0.97)), "g");
  EXPECT_EQ(unit_found(at_rest("t (s),x,y,z", 1001.5)), "mg");
  EXPECT_EQ(unit_found(at_rest("t (s),accX,accY,accZ", -1.0)), "g");
}

TEST(ChannelUnits, CallsWholeNumbersCounts) {
  EXPECT_EQ(unit_found(at_rest("t (s),ax,ay,az", 16384.0, true)), "counts");
  const auto read = read_text(at_rest("t (s),ax,ay,az", 16384.0, true));
  EXPECT_EQ(accelerometer_triads(*read).size(), 1u);
}

TEST(ChannelUnits, SaysWhereItCannotTell) {
  const auto read = read_text(at_rest("t (s),ax,ay,az", 3.3));
  EXPECT_EQ(read->channels[0].unit.quantity, Quantity::unknown);
  EXPECT_TRUE(recommends(*read, "unit")) << notes_of(*read);
}

TEST(ChannelUnits, SaysHowItTold) {
  const auto read = read_text(at_rest("t (s),ax,ay,az", 9.81));
  EXPECT_TRUE(is_noted(*read, "ax, ay, az: unit taken to be m/s^2: in the quietest second"))
      << notes_of(*read);
}

TEST(ChannelUnits, BelievesTheUserBeforeTheHeader) {
  EXPECT_EQ(unit_found(at_rest("t (s),ax (g),ay (g),az (g)", 9.81), {.unit = parse_unit("m/s^2")}),
            "m/s^2");
  EXPECT_EQ(unit_found(at_rest("t (s),ax,ay,az", 9.81), {.unit = parse_unit("mV")}), "mV");
  EXPECT_EQ(unit_found("t (s),left,right\n0,1,2\n1,1,2\n", {.unit = parse_unit("V")}), "V");
}

TEST(ChannelUnits, IsNotLedAstrayByCorruptRows) {
  std::string text = at_rest("t (s),ax,ay,az", 9.81);
  for (int k = 3; k < 6; ++k) text += std::to_string(k) + ",3e34,nan,1e-310\n";
  EXPECT_EQ(unit_found(text), "m/s^2");
}

TEST(ChannelUnits, KnowsAnXsensUnitByItsColumns) {
  const auto read = read_text(
      "sep=,\nPacketCounter,SampleTimeFine,Euler_X,Acc_X,Acc_Y,Acc_Z,Gyr_X,\n"
      "0, 100000, 1, 0, 0, 0, 0, \n1, 108333, 1, 30, 40, 50, 2, \n2, 116666, 1, 30, 40, 50, 2, \n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->find("Acc_X")->unit.symbol, "m/s^2");
  EXPECT_EQ(read->find("Gyr_X")->unit.symbol, "deg/s");
  EXPECT_EQ(read->find("Euler_X")->unit.symbol, "deg");
  EXPECT_EQ(read->find("PacketCounter")->unit.quantity, Quantity::counts);
  EXPECT_NEAR(read->time.rate_hz, 120.0048, 1e-4);
}

TEST(ChannelUnits, DoesNotTakeAGyroscopeForAnAccelerometer) {
  const auto read = read_text("t (s),gyr_x,gyr_y,gyr_z\n0,1,2,3\n1,1,2,3\n2,1,2,4\n");
  EXPECT_TRUE(accelerometer_triads(*read).empty());
}

TEST(ChannelUnits, ReadsGaussOnAnAccelerometerAsG) {
  EXPECT_EQ(unit_found(at_rest("t (s),Acc X (G),Acc Y (G),Acc Z (G)", 1.0)), "g");
}

}  // namespace
}  // namespace proofmass::io::channel_units_test
