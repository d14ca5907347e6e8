#include "proofmass/io/positions/instant_list.hpp"

#include <gtest/gtest.h>
#include <string_view>

namespace proofmass::io::instant_list_test {
namespace {

Result<std::vector<Instant>> instants(std::string_view text) {
  return read_instants(std::as_bytes(std::span(text)), "fixes.csv");
}

/// The error message for a rejected text.
std::string refusal(std::string_view text) {
  const auto read = instants(text);
  return read ? "was read" : read.error().message;
}

TEST(ReadInstants, ReadsTimePositionAndStdInTheOrderOfTheTimes) {
  const auto read = instants("time (s),position (m),std (m)\n4.5,0.25,0.002\n1,-0.5,0.01\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].time_s, 1.0);
  EXPECT_EQ((*read)[0].position_m, -0.5);
  EXPECT_EQ((*read)[0].std_m, 0.01);
  EXPECT_EQ((*read)[0].line, 3u);
  EXPECT_EQ((*read)[1].time_s, 4.5);
}

TEST(ReadInstants, TakesTheUnitsThatTheHeadingsName) {
  const auto read = instants("t (ms);position (cm);std (mm)\n1500;25;2\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_DOUBLE_EQ((*read)[0].time_s, 1.5);
  EXPECT_DOUBLE_EQ((*read)[0].position_m.value(), 0.25);
  EXPECT_DOUBLE_EQ((*read)[0].std_m.value(), 0.002);
  const auto joined = instants("time_s,position_mm\n1,250\n");
  ASSERT_TRUE(joined.has_value()) << joined.error().message;
  EXPECT_DOUBLE_EQ((*joined)[0].position_m.value(), 0.25);
}

TEST(ReadInstants, AStdWithoutAUnitIsInThatOfThePosition) {
  const auto read = instants("time,position (mm),std\n1,250,2\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_DOUBLE_EQ((*read)[0].std_m.value(), 0.002);
}

TEST(ReadInstants, TimesAloneAreEnough) {
  for (const char* text : {"time (s)\n1.5\n2.5\n", "1.5\n2.5\n", "turns\n1.5\n2.5\n"}) {
    const auto read = instants(text);
    ASSERT_TRUE(read.has_value()) << text << read.error().message;
    ASSERT_EQ(read->size(), 2u) << text;
    EXPECT_EQ((*read)[1].time_s, 2.5);
    EXPECT_FALSE((*read)[0].position_m.has_value());
  }
}

TEST(ReadInstants, ABlankInTheHeadingOfTheOnlyColumnSeparatesNothing) {
  const auto read = instants("time (ms)\n1500\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_DOUBLE_EQ((*read)[0].time_s, 1.5);
  EXPECT_EQ(instants("1.5 0.25\n2 0.5\n").value()[1].position_m, 0.5);
}

TEST(ReadInstants, WithoutAHeaderTheColumnsAreTimePositionAndStd) {
  const auto read = instants("1;0,25;0,01\n2;0,5;0,01\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ((*read)[1].position_m, 0.5);
  EXPECT_EQ((*read)[1].std_m, 0.01);
}

TEST(ReadInstants, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(refusal("time,position\n1,0.2\n2,there\n"),
            "fixes.csv: line 3: the position is not a number");
  EXPECT_EQ(refusal("time,position\nsoon,0.2\n"), "fixes.csv: line 2: the time is not a number");
  EXPECT_EQ(refusal("time,position,std\n1,0.2,0\n"),
            "fixes.csv: line 2: the standard deviation is not a number above 0");
  EXPECT_EQ(refusal("time\n1\n2\n1\n"), "fixes.csv: line 4: the same time as in line 2");
  EXPECT_EQ(refusal("time,position\n"), "fixes.csv: has no row");
  EXPECT_NE(refusal("place,colour\n1,2\n").find("expected a header with time"), std::string::npos);
  EXPECT_NE(refusal("time (m),position (m)\n1,2\n").find("expected a header"), std::string::npos);
}

TEST(ReadInstants, AnInstantOutsideTheRecordingIsNamed) {
  const auto read = instants("time\n1\n9\n").value();
  EXPECT_TRUE(check_inside(read, 9.0).has_value());
  const Status outside = check_inside(read, 8.0);
  ASSERT_FALSE(outside.has_value());
  EXPECT_NE(outside.error().message.find("line 3: 9 s is outside the recording"),
            std::string::npos);
}

TEST(ReadInstants, InstantsOutsideTheRecordingAreDropped) {
  auto read = instants("time\n-0.01\n0\n1\n8\n8.004\n").value();
  EXPECT_EQ(drop_outside(read, 8.0), 2U);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read.front().time_s, 0.0);
  EXPECT_EQ(read.back().time_s, 8.0);
}

}  // namespace
}  // namespace proofmass::io::instant_list_test
