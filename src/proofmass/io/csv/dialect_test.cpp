#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::csv_dialect_test {
namespace {

using Values = std::vector<double>;

/// In any dialect, the result must be these two rows of time, x and y.
void expect_two_rows(const Result<Recording>& read) {
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 2u) << notes_of(*read);
  EXPECT_EQ(read->channels[0].values, (Values{1.5, -2.5, 3.0})) << notes_of(*read);
  EXPECT_EQ(read->channels[1].values, (Values{4.0, 5.25, -6.0}));
  EXPECT_EQ(read->time.source, TimeSource::stamps);
  EXPECT_DOUBLE_EQ(read->time.rate_hz, 100.0);
}

TEST(CsvDialect, ReadsEverySeparator) {
  expect_two_rows(read_text("t,ax,ay\n0,1.5,4\n0.01,-2.5,5.25\n0.02,3,-6\n"));
  expect_two_rows(read_text("t;ax;ay\n0;1.5;4\n0.01;-2.5;5.25\n0.02;3;-6\n"));
  expect_two_rows(read_text("t\tax\tay\n0\t1.5\t4\n0.01\t-2.5\t5.25\n0.02\t3\t-6\n"));
  expect_two_rows(read_text("t|ax|ay\n0|1.5|4\n0.01|-2.5|5.25\n0.02|3|-6\n"));
  expect_two_rows(read_text("t ax ay\n0 1.5  4\n  0.01 -2.5 5.25\n0.02\t3 -6 \n"));
}

TEST(CsvDialect, ReadsDecimalCommas) {
  expect_two_rows(read_text("t;ax;ay\n0;1,5;4\n0,01;-2,5;5,25\n0,02;3;-6\n"));
  expect_two_rows(read_text("t\tax\tay\n0\t1,5\t4\n0,01\t-2,5\t5,25\n0,02\t3\t-6\n"));
  expect_two_rows(read_text("t ax ay\n0,0 1,5 4,0\n0,01 -2,5 5,25\n0,02 3,0 -6,0\n"));
}

TEST(CsvDialect, ReadsHalvesBelowOneNameAsOneColumn) {
  const auto read = read_text("Voltage (V)\n0,5\n1,5\n2,25\n");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->channels.size(), 1u);
  EXPECT_EQ(read->channels[0].values, (Values{0.5, 1.5, 2.25}));
}

TEST(CsvDialect, ObeysASeparatorLine) {
  expect_two_rows(read_text("sep=;\nt;ax;ay\n0;1.5;4\n0.01;-2.5;5.25\n0.02;3;-6\n"));
  expect_two_rows(read_text("\xEF\xBB\xBFsep=:\nt:ax:ay\n0:1.5:4\n0.01:-2.5:5.25\n0.02:3:-6\n"));
}

TEST(CsvDialect, ReadsEveryLineEnd) {
  expect_two_rows(read_text("t,ax,ay\r\n0,1.5,4\r\n0.01,-2.5,5.25\r\n0.02,3,-6\r\n"));
  expect_two_rows(read_text("t,ax,ay\r0,1.5,4\r0.01,-2.5,5.25\r0.02,3,-6\r"));
  expect_two_rows(read_text("t,ax,ay\n0,1.5,4\r\n0.01,-2.5,5.25\n0.02,3,-6"));
}

TEST(CsvDialect, ReadsEveryEncoding) {
  const std::string text = "t,ax,ay\n0,1.5,4\n0.01,-2.5,5.25\n0.02,3,-6\n";
  expect_two_rows(read_text("\xEF\xBB\xBF" + text));
  for (const bool big : {false, true}) {
    for (const bool marked : {false, true}) {
      std::string wide = !marked ? "" : big ? "\xFE\xFF" : "\xFF\xFE";
      for (const char c : text) {
        if (big) wide += '\0';
        wide += c;
        if (!big) wide += '\0';
      }
      expect_two_rows(read_text(wide));
    }
  }
}

TEST(CsvDialect, ReadsTrailingSeparators) {
  expect_two_rows(read_text("t,ax,ay,\n0, 1.5, 4, \n0.01, -2.5, 5.25, \n0.02, 3, -6, \n"));
  expect_two_rows(read_text("t;ax;ay\n0;1.5;4;\n0.01;-2.5;5.25;\n0.02;3;-6;\n"));
}

TEST(CsvDialect, ReadsQuotes) {
  expect_two_rows(
      read_text("\"t\",\"ax\",\"ay\"\n\"0\",\"1.5\",\"4\"\n\"0.01\",\"-2.5\",\"5.25\"\n"
                "\"0.02\",\"3\",\"-6\"\n"));
  const auto read = read_text(
      "\"Time, s\",\"Acc X, g\",\"Acc Y, g\"\n0,1.5,4\n0.01,-2.5,5.25\n"
      "0.02,3,-6\n");
  expect_two_rows(read);
  EXPECT_EQ(read->channels[0].name, "Acc X");
  EXPECT_EQ(read->channels[0].unit.symbol, "g");
}

TEST(CsvDialect, PassesOverRemarks) {
  for (const std::string mark : {"#", "%", "//", ";"})
    expect_two_rows(read_text(mark + " logger 3\n" + mark + " gain, high\nt,ax,ay\n0,1.5,4\n" +
                              "0.01,-2.5,5.25\n" + mark + " stopped\n0.02,3,-6\n"));
}

TEST(CsvDialect, FindsTheHeaderInARemark) {
  expect_two_rows(read_text("# made by hand\n# t, ax, ay\n0,1.5,4\n0.01,-2.5,5.25\n0.02,3,-6\n"));
  expect_two_rows(read_text(";Headers, time,Ax,Ay\n0,1.5,4\n0.01,-2.5,5.25\n0.02,3,-6\n"));
}

TEST(CsvDialect, ReadsARateInThePreamble) {
  for (const char* preamble : {";SampleRate, 64,Hz\n", "# sample rate: 64.0 Hz\n",
                               "// Update Rate: 0.064kHz\n", "Sampling frequency,64\n"}) {
    const auto read = read_text(preamble + std::string("x,y,z\n0.5,1,9\n0.5,1.5,9\n"));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->time.source, TimeSource::given_rate) << preamble;
    EXPECT_EQ(read->time.rate_hz, 64.0) << preamble;
  }
}

TEST(CsvDialect, ReadsUnitsWhereverTheyStand) {
  const std::string rows = "0,1.5,4\n10,-2.5,5.25\n20,3,-6\n";
  for (const std::string header :
       {"t (ms),ax (m/s^2),gx (deg/s)\n", "t [ms],ax [m/s²],gx [°/s]\n", "t_ms,ax_mps2,gx_dps\n",
        "t_ms,ax_m_s2,gx_deg_s\n", "t,ax,gx\nms,m/s^2,deg/s\n", "t,ax,gx\n(ms),(m/s2),(deg/s)\n",
        "\"t, ms\",\"ax, m/s^2\",\"gx, deg/s\"\n", "t ms,ax m/s^2,gx deg/s\n"}) {
    const auto read = read_text(header + rows);
    expect_two_rows(read);
    EXPECT_EQ(read->channels[0].name, "ax") << header;
    EXPECT_EQ(read->channels[0].unit, *parse_unit("m/s^2")) << header;
    EXPECT_EQ(read->channels[1].unit, *parse_unit("deg/s")) << header;
  }
}

TEST(CsvDialect, JoinsAHeaderOfTwoRows) {
  const auto read = read_text(
      "Time (s);IMU Acceleration;;;Temp;\n;X;Y;Z;A;\n0;1;2;9.5;20;\n"
      "0.01;1;2;9.5;20;\n0.02;1;2;9.5;20;\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 4u);
  EXPECT_EQ(read->channels[0].name, "IMU Acceleration X");
  EXPECT_EQ(read->channels[2].name, "IMU Acceleration Z");
  EXPECT_EQ(read->channels[3].name, "Temp A");
  EXPECT_DOUBLE_EQ(read->time.rate_hz, 100.0);
}

TEST(CsvDialect, MendsAHeaderThatLacksASeparator) {
  const auto read = read_text(
      "Data on a level surface.\ntime (s)x (g),y (g),z (g)\n"
      "0.01,0.1,0.2,1\n0.02,0.1,0.2,1\n0.03,0.1,0.2,1\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[0].name, "x");
  EXPECT_EQ(read->channels[0].unit.symbol, "g");
  EXPECT_TRUE(is_noted(*read, "separator is missing"));
}

TEST(CsvDialect, NamesTheColumnsOfATableWithoutHeader) {
  const auto timed = read_text("0.00 0.1 0.2 9.8\n0.01 0.1 0.2 9.8\n0.02 0.1 0.2 9.8\n");
  ASSERT_TRUE(timed.has_value());
  EXPECT_EQ(timed->time.channel, "time");
  ASSERT_EQ(timed->channels.size(), 3u);
  EXPECT_EQ(timed->channels[0].name, "x");
  EXPECT_EQ(timed->channels[2].unit.symbol, "m/s^2");
  ASSERT_EQ(accelerometer_triads(*timed).size(), 1u);
  EXPECT_EQ(accelerometer_triads(*timed)[0].axes(), 3u);

  const auto bare = read_text("5,1\n4,2\n7,3\n");
  ASSERT_TRUE(bare.has_value());
  EXPECT_EQ(bare->time.source, TimeSource::none);
  EXPECT_EQ(bare->channels[1].name, "column 2");
}

TEST(CsvDialect, MakesNamesUniqueAndSaysSo) {
  const auto read = read_text("t,x,x,\n0,1,2\n1,3,4\n2,5,6\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->channels[0].name, "x");
  EXPECT_EQ(read->channels[1].name, "x 2");
  EXPECT_TRUE(is_noted(*read, "two columns are called x"));
}

TEST(CsvDialect, TellsWhatItFound) {
  const auto read = read_text("% by hand\nt;ax\n0;1,5\n0,01;2,5\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->format, "CSV");
  EXPECT_EQ(read->first_line, 3u);
  EXPECT_TRUE(is_noted(*read, "separator semicolon, decimal comma, header on line 2"))
      << notes_of(*read);
}

TEST(CsvDialect, AColumnWithAnotherUnitIsNoTimeWhateverItsName) {
  const auto read = read_text("ax (g),T (degC)\n1,20\n2,21\n3,22\n1,23\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 2u);
  EXPECT_EQ(read->channels[0].name, "ax");
  EXPECT_EQ(read->channels[1].name, "T");
  EXPECT_EQ(read->time.source, TimeSource::none);
}

}  // namespace
}  // namespace proofmass::io::csv_dialect_test
