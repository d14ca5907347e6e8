#include "proofmass/io/positions/interval_list.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string_view>

namespace proofmass::io::interval_list_test {
namespace {

Result<std::vector<Interval>> intervals(std::string_view text) {
  return read_intervals(std::as_bytes(std::span(text)), "rests.csv");
}

/// The error message for a rejected text.
std::string refusal(std::string_view text) {
  const auto read = intervals(text);
  return read ? "was read" : read.error().message;
}

TEST(ReadIntervals, ReadsSecondsLabelsAndDirections) {
  const auto read = intervals(
      "start,end,label,up_x,up_y,up_z\n0.5,10.25,\"x, up\",2,0,0\n12,20,tilted,0,3,4\n21,22,,,,\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->size(), 3u);
  EXPECT_EQ((*read)[0].start, 0.5);
  EXPECT_EQ((*read)[0].end, 10.25);
  EXPECT_FALSE((*read)[0].in_samples);
  EXPECT_EQ((*read)[0].label, "x, up");
  EXPECT_EQ((*read)[0].up, (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ((*read)[1].up, (std::array<double, 3>{0, 0.6, 0.8}));
  EXPECT_EQ((*read)[1].line, 3u);
  EXPECT_EQ((*read)[2].label, "");
  EXPECT_EQ((*read)[2].up, std::nullopt);
}

TEST(ReadIntervals, ReadsTheAngleOfATable) {
  constexpr double pi = 3.14159265358979;
  for (const char* heading : {"angle", "angle (deg)", "Angle [°]"}) {
    const auto read = intervals("start,end," + std::string(heading) + "\n0,1,180\n2,3,\n");
    ASSERT_TRUE(read.has_value()) << read.error().message;
    ASSERT_TRUE((*read)[0].angle_rad) << heading;
    EXPECT_NEAR(*(*read)[0].angle_rad, pi, 1e-12) << heading;
    EXPECT_FALSE((*read)[1].angle_rad) << heading;
  }
  EXPECT_NEAR(*intervals("start,end,angle (rad)\n0,1,2\n").value().front().angle_rad, 2.0, 1e-12);
  EXPECT_FALSE(intervals("start,end\n0,1\n").value().front().angle_rad);
}

TEST(ReadIntervals, KnowsTheHeadingsPeopleWrite) {
  for (const char* header : {"start_s,end_s", "Start (s),End (s)", "t_start,t_end", "from,to",
                             "begin,stop", "start time [s],end time [s]"}) {
    const auto read = intervals(std::string(header) + "\n1,2\n3,4\n");
    ASSERT_TRUE(read.has_value()) << header << ": " << read.error().message;
    EXPECT_EQ((*read)[1].start, 3.0) << header;
    EXPECT_FALSE((*read)[0].in_samples) << header;
  }
  for (const char* header : {"first,last", "start_sample,end_sample", "start (samples),end",
                             "first sample,last sample", "start index,end index"}) {
    const auto read = intervals(std::string(header) + "\n1,2\n3,3\n");
    ASSERT_TRUE(read.has_value()) << header << ": " << read.error().message;
    EXPECT_EQ((*read)[1].end, 3.0) << header;
    EXPECT_TRUE((*read)[0].in_samples) << header;
  }
  const auto in_ms = intervals("start (ms);end (ms);part\n1,5;2500;up\n");
  ASSERT_TRUE(in_ms.has_value()) << in_ms.error().message;
  EXPECT_DOUBLE_EQ((*in_ms)[0].start, 0.0015);
  EXPECT_DOUBLE_EQ((*in_ms)[0].end, 2.5);
}

TEST(ReadIntervals, ReadsAnAudacityLabelTrack) {
  const auto read = intervals(
      "0.500000\t10.250000\tx up\n\\\t100.000000\t200.000000\n12.000000\t20.000000\t\n"
      "20.000000\t21.5\tz, down\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->size(), 3u);
  EXPECT_EQ((*read)[0].label, "x up");
  EXPECT_EQ((*read)[0].end, 10.25);
  EXPECT_EQ((*read)[1].label, "");
  EXPECT_EQ((*read)[2].label, "z, down");
  const auto one = intervals("0,5\t1,25\tx up\r\n");
  ASSERT_TRUE(one.has_value()) << one.error().message;
  EXPECT_EQ((*one)[0].end, 1.25);
  EXPECT_EQ((*one)[0].label, "x up");
  const auto blanks = intervals("0.5 1.25 x up\n2 3 on its side\n");
  ASSERT_TRUE(blanks.has_value()) << blanks.error().message;
  EXPECT_EQ((*blanks)[1].label, "on its side");
}

TEST(ReadIntervals, PutsThemInTheOrderOfTime) {
  const auto read = intervals("start,end\n5,6\n1,2\n2,3\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ((*read)[0].start, 1.0);
  EXPECT_EQ((*read)[1].start, 2.0);
  EXPECT_EQ((*read)[2].line, 2u);
}

TEST(ReadIntervals, SaysWhichLineIsWrongAndWhy) {
  EXPECT_EQ(refusal("start,end\n1,2\n5,4\n"),
            "rests.csv: line 3: ends at 4, which is not after its start at 5");
  EXPECT_EQ(refusal("start,end\n1,1\n"),
            "rests.csv: line 2: ends at 1, which is not after its start at 1");
  EXPECT_EQ(refusal("start,end\n1,3\n\n2.5,4\n"),
            "rests.csv: line 4: begins at 2.5, within the interval of line 2 that ends at 3");
  EXPECT_EQ(refusal("first,last\n0,10\n10,20\n"),
            "rests.csv: line 3: begins at 10, within the interval of line 2 that ends at 10");
  EXPECT_EQ(refusal("first,last\n0.5,10\n"),
            "rests.csv: line 2: the number of a sample is whole and not below zero");
  EXPECT_EQ(refusal("start,end\n1,2\n3,?\n4,5\n"),
            "rests.csv: line 3: start or end is not a number");
  EXPECT_EQ(refusal("start,end\n1,2\n3\n4,5\n"), "rests.csv: line 3: start or end is not a number");
  EXPECT_EQ(refusal("start,end\n1,inf\n"), "rests.csv: line 2: start or end is not a number");
  EXPECT_EQ(refusal("start,end,up_x,up_y,up_z\n1,2,0,0,0\n"),
            "rests.csv: line 2: the direction needs three figures that are not all zero");
  EXPECT_EQ(refusal("start,end,up_x,up_y,up_z\n1,2,0,1,\n"),
            "rests.csv: line 2: the direction needs three figures that are not all zero");
  EXPECT_EQ(refusal("start,end,up_x\n1,2,1\n"),
            "rests.csv: line 1: a direction needs all of x, y and z");
  EXPECT_EQ(refusal("start_s,last sample\n1,2\n"),
            "rests.csv: line 1: one of start and end is in seconds, the other in samples");
  EXPECT_NE(refusal("a,b\n1,2\n").find("line 1: expected a header with start and end"),
            std::string::npos);
  EXPECT_NE(refusal("").find("is empty"), std::string::npos);
  EXPECT_NE(refusal("start,end\n").find("has no interval"), std::string::npos);
  EXPECT_NE(read_intervals("/no/such/list.csv").error().message.find("/no/such/list.csv: "),
            std::string::npos);
}

TEST(CheckInside, NamesTheIntervalThatTheRecordingDoesNotHave) {
  const auto seconds = intervals("start,end\n0,2\n3,10\n");
  EXPECT_TRUE(check_inside(*seconds, 10.0, 1001).has_value());
  EXPECT_TRUE(check_inside(*seconds, 9.99, 1000).has_value()) << "one step beyond the last";
  const Status late = check_inside(*seconds, 9.5, 951);
  ASSERT_FALSE(late.has_value());
  EXPECT_EQ(late.error().message,
            "line 3: the interval from 3 to 10 is outside the recording, which has 0 s to 9.5 s");
  EXPECT_FALSE(check_inside(intervals("start,end\n-1,2\n").value(), 9.5, 951).has_value());
  const auto samples = intervals("first,last\n0,2\n3,10\n");
  EXPECT_TRUE(check_inside(*samples, 0.1, 11).has_value());
  EXPECT_EQ(check_inside(*samples, 100.0, 10).error().message,
            "line 3: the interval from 3 to 10 is outside the recording, which has samples 0 to 9");
}

}  // namespace
}  // namespace proofmass::io::interval_list_test
