#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/lvm/specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::lvm::lvm_test {
namespace {

using namespace specimen;
using Values = std::vector<double>;

const std::string three_rows = "\t1.000000\t2.000000\n\t3.000000\t4.000000\n\t5.000000\t6.000000\n";

Result<Recording> read_lvm(const std::string& segments, const LvmFileHeader& header = {}) {
  return read_text(lvm_header(header) + segments);
}

ReadOptions chosen(std::string table) {
  ReadOptions options;
  options.variables = {std::move(table)};
  return options;
}

/// Nanoseconds from 1970 to 2024-03-01 12:00:00 UTC.
constexpr std::int64_t noon_ns = 1'709'294'400'000'000'000;

TEST(Lvm, ReadsChannelsAtDeltaXFromTheirStart) {
  const auto read = read_lvm(lvm_segment({}, three_rows));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "LVM");
  ASSERT_EQ(read->channels.size(), 2u);
  EXPECT_EQ(read->channels[0].name, "a");
  EXPECT_EQ(read->channels[0].unit.symbol, "g");
  EXPECT_EQ(read->channels[1].unit.symbol, "V");
  EXPECT_EQ(read->channels[0].values, (Values{1, 3, 5}));
  EXPECT_EQ(read->channels[1].values, (Values{2, 4, 6}));
  EXPECT_EQ(read->time.rate_hz, 100.0);
  EXPECT_TRUE(read->time.is_uniform());
  EXPECT_EQ(read->time.start_ns, noon_ns + 1'000'000'000);
  EXPECT_TRUE(is_noted(*read, "6 decimals"));
  EXPECT_TRUE(is_noted(*read, "taken as UTC"));
  EXPECT_TRUE(is_noted(*read, "Operator \"me\""));
}

TEST(Lvm, ReadsLinesThatEndInEitherWay) {
  std::string text = lvm_header() + lvm_segment({}, three_rows);
  std::string with_returns;
  for (const char c : text) with_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const auto read = read_text(with_returns);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[1].values, (Values{2, 4, 6}));
}

TEST(Lvm, ReadsDecimalCommasWhateverTheSeparator) {
  const std::string rows = "\t0,914018\t-1,5\n\t0,537321\t1,25E-2\n";
  for (const char* stated : {",", ""}) {
    LvmSegmentText segment;
    segment.delta_x = {"3,906250E-5", "3,906250E-5"};
    segment.samples = "2";
    const auto read = read_lvm(lvm_segment(segment, rows), {.decimal_separator = stated});
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->channels[0].values, (Values{0.914018, 0.537321}));
    EXPECT_EQ(read->channels[1].values, (Values{-1.5, 0.0125}));
    EXPECT_DOUBLE_EQ(read->time.rate_hz, 1.0 / 3.90625e-5);
  }
}

TEST(Lvm, ReadsCommasThatSeparateAndCommasThatArePoints) {
  LvmSegmentText segment;
  segment.separator = ',';
  segment.samples = "2";
  const LvmFileHeader points{.separator = ',', .separator_name = "Comma"};
  const auto plain = read_lvm(lvm_segment(segment, "\t0.5\t-1.5\n\t0.25\t\n"), points);
  ASSERT_TRUE(plain.has_value()) << plain.error().message;
  EXPECT_EQ(plain->channels[0].values, (Values{0.5, 0.25}));
  EXPECT_TRUE(std::isnan(plain->channels[1].values[1]));
  const LvmFileHeader commas{.separator = ',', .separator_name = "Comma", .decimal_separator = ","};
  segment.delta_x = {"0\t02", "0\t02"};  // tabs become commas
  const auto both =
      read_lvm(lvm_segment(segment, ",0,500000,-1,500000\n,0,250000,3,000000\n"), commas);
  ASSERT_TRUE(both.has_value()) << both.error().message;
  EXPECT_EQ(both->channels[0].values, (Values{0.5, 0.25}));
  EXPECT_EQ(both->channels[1].values, (Values{-1.5, 3.0}));
  EXPECT_EQ(both->time.rate_hz, 50.0);
}

TEST(Lvm, TakesXValuesForTheTime) {
  LvmSegmentText segment;
  segment.samples = "1";
  const auto read = read_lvm(
      lvm_segment(segment, "0.250000\t1\t2\n0.500000\t3\t4\n1.500000\t5\t6\n1.750000\t7\t8\n"),
      {.x_columns = "One"});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 2u);
  ASSERT_EQ(read->time.stamps_s, (Values{0, 0.25, 1.25, 1.5}));
  EXPECT_EQ(read->time.start_ns, noon_ns + 1'250'000'000);
}

TEST(Lvm, CountsAbsoluteXValuesFrom1904) {
  // 2024-03-01 12:00:00 UTC is 3 792 139 200 s after the beginning of 1904.
  const auto read = read_lvm(lvm_segment({},
                                         "3792139200.500000\t1\t2\n3792139200.510000\t3\t4\n"
                                         "3792139200.521000\t5\t6\n"),
                             {.x_columns = "One", .time_pref = "Absolute"});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.start_ns, noon_ns + 500'000'000);
  EXPECT_EQ(read->time.stamps_s, (Values{0, 0.01, 0.021}));
}

TEST(Lvm, TakesTheXValuesOfTheFirstOfSeveralChannels) {
  LvmSegmentText segment;
  segment.is_multi = true;
  const std::string same = "0.00\t1\t0.00\t2\n0.01\t3\t0.01\t4\n0.02\t5\t0.02\t6\n";
  const auto read = read_lvm(lvm_segment(segment, same), {.x_columns = "Multi"});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, (Values{1, 3, 5}));
  EXPECT_EQ(read->channels[1].values, (Values{2, 4, 6}));
  EXPECT_EQ(read->channels[1].unit.symbol, "V");
  EXPECT_EQ(read->time.rate_hz, 100.0);
  EXPECT_FALSE(is_noted(*read, "X values of their own"));
  const std::string other = "0.00\t1\t0.001\t2\n0.01\t3\t0.011\t4\n0.02\t5\t0.021\t6\n";
  const auto skewed = read_lvm(lvm_segment(segment, other), {.x_columns = "Multi"});
  ASSERT_TRUE(skewed.has_value());
  EXPECT_TRUE(is_noted(*skewed, "X values of their own in 3 rows"));
}

TEST(Lvm, ChannelsOfAnotherStepAreATableOfTheirOwn) {
  LvmSegmentText segment;
  segment.delta_x = {"0.01", "0.1"};
  const std::string rows = "\t1\t2\n\t3\t\n\t5\t\n";
  const auto fast =
      read_text(lvm_header() + lvm_segment(segment, rows), chosen("segment 1 at 100 Hz"));
  ASSERT_TRUE(fast.has_value()) << fast.error().message;
  EXPECT_EQ(fast->time.rate_hz, 100.0);
  ASSERT_EQ(fast->channels.size(), 1u);
  EXPECT_EQ(fast->channels[0].values, (Values{1, 3, 5}));
  const auto slow =
      read_text(lvm_header() + lvm_segment(segment, rows), chosen("segment 1 at 10 Hz"));
  ASSERT_TRUE(slow.has_value()) << slow.error().message;
  EXPECT_EQ(slow->channels[0].name, "b");
}

TEST(Lvm, SegmentsThatFollowEachOtherAreOneEvenTable) {
  LvmSegmentText second;
  second.time = "12:00:01.03";
  const auto read =
      read_lvm(lvm_segment({}, three_rows) + "\t\n" + lvm_segment(second, three_rows));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, (Values{1, 3, 5, 1, 3, 5}));
  EXPECT_TRUE(read->time.is_uniform());
  EXPECT_EQ(read->time.rate_hz, 100.0);
  EXPECT_TRUE(is_noted(*read, "2 segments are one table"));
}

TEST(Lvm, SegmentsApartKeepTheirTimes) {
  LvmSegmentText second;
  second.time = "12:00:02";
  second.x0 = {"0.5", "0.5"};
  const auto read = read_lvm(lvm_segment({}, three_rows) + lvm_segment(second, three_rows));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->time.stamps_s.size(), 6u);
  EXPECT_NEAR(read->time.stamps_s[2], 0.02, 1e-12);
  EXPECT_NEAR(read->time.stamps_s[3], 1.5, 1e-12);
  EXPECT_NEAR(read->time.stamps_s[5], 1.52, 1e-12);
}

TEST(Lvm, TheStartsOfSegmentsTellTheStepThatDeltaXRounds) {
  // 1024 Hz: 0.0009765625 s is written as 0.000977, which would make 1000 rows 0.4 ms too long.
  std::string text = lvm_header();
  std::string rows;
  for (int k = 0; k < 1000; ++k) rows += "\t1.0\t2.0\n";
  for (const char* time : {"12:00:00.0000000", "12:00:00.9765625", "12:00:01.9531250"}) {
    LvmSegmentText segment;
    segment.time = time;
    segment.samples = "1000";
    segment.delta_x = {"0.000977", "0.000977"};
    text += lvm_segment(segment, rows);
  }
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_NEAR(read->time.rate_hz, 1024.0, 1e-4);
  EXPECT_TRUE(read->time.is_uniform());
}

TEST(Lvm, X0CountsOnFromTheFirstSegmentWhereThatFits) {
  LvmSegmentText second;
  second.time = "12:00:31";
  second.x0 = {"0.03", "0.03"};
  const auto read = read_lvm(lvm_segment({}, three_rows) + lvm_segment(second, three_rows));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.rate_hz, 100.0);
  EXPECT_TRUE(read->time.is_uniform());
  EXPECT_TRUE(is_noted(*read, "X0 counts from the first segment's start"));
}

TEST(Lvm, SegmentsOfOtherChannelsAreOtherTables) {
  LvmSegmentText other;
  other.names = {"p", "q"};
  other.units = {"m/s^2", "m/s^2"};
  const std::string text = lvm_header() + lvm_segment({}, three_rows) +
                           lvm_segment(other, three_rows) + lvm_segment({}, three_rows);
  const auto first = read_text(text, chosen("segment 1"));
  ASSERT_TRUE(first.has_value()) << first.error().message;
  EXPECT_EQ(first->samples(), 6u);
  EXPECT_EQ(first->channels[0].name, "a");
  const auto second = read_text(text, chosen("segment 2"));
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->channels[0].name, "p");
}

TEST(Lvm, PassesOverSpecialBlocksAndTellsComments) {
  const std::string special =
      "***Start_Special***\nPacket_Notes\nChannels\t9\n1\t2\t3\n***End_Special***\n";
  const auto read =
      read_lvm(special + lvm_segment({}, "\t1\t2\tshaken, not stirred\n\t3\t4\n\t5\t6\n"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, (Values{1, 3, 5}));
  EXPECT_TRUE(is_noted(*read, "Packet_Notes (once)"));
  EXPECT_TRUE(is_noted(*read, "shaken, not stirred")) << notes_of(*read);
}

TEST(Lvm, NeedsNoLineOfColumnNames) {
  LvmSegmentText segment;
  segment.has_names = false;
  const auto read = read_lvm(lvm_segment(segment, three_rows));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[1].name, "channel_2");
  EXPECT_EQ(read->channels[1].unit.symbol, "V");
  EXPECT_EQ(read->samples(), 3u);
}

TEST(Lvm, FieldsWithoutAFigureAreNaN) {
  const auto read = read_lvm(lvm_segment({}, "\t\t2\n\tNaN\t4\n\toops\t6\n\tInf\n"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->samples(), 4u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(std::isnan(read->channels[0].values[k]));
  EXPECT_TRUE(std::isinf(read->channels[0].values[3]));
  EXPECT_TRUE(std::isnan(read->channels[1].values[3]));
  EXPECT_TRUE(is_noted(*read, "\"oops\""));
}

TEST(Lvm, TellsWhereItBreaksOff) {
  const std::string whole = lvm_header() + lvm_segment({}, three_rows);
  const auto cut = read_text(whole.substr(0, whole.size() - 4));
  ASSERT_TRUE(cut.has_value()) << cut.error().message;
  EXPECT_EQ(cut->samples(), 3u);
  EXPECT_TRUE(std::isnan(cut->channels[1].values[2]));
  EXPECT_TRUE(is_noted(*cut, "breaks off within the row"));
  const auto shorter = read_text(whole.substr(0, whole.size() - 20));
  ASSERT_TRUE(shorter.has_value());
  EXPECT_EQ(shorter->samples(), 2u);
  EXPECT_TRUE(is_noted(*shorter, "2 rows of the 3")) << notes_of(*shorter);
  // Without the last line end a file may still be complete.
  const auto whole_still = read_text(whole.substr(0, whole.size() - 1));
  ASSERT_TRUE(whole_still.has_value());
  EXPECT_EQ(whole_still->channels[1].values[2], 6.0);
}

TEST(Lvm, SaysWhyItCannot) {
  const auto code = [](const std::string& text) {
    const auto read = read_text(text);
    return read ? Errc::invalid_argument : read.error().code;
  };
  EXPECT_EQ(code("LabVIEW Measurement\t\nWriter_Version\t2\n"), Errc::corrupt);
  EXPECT_EQ(code(lvm_header()), Errc::corrupt);
  EXPECT_EQ(code(lvm_header() + lvm_segment({}, "")), Errc::corrupt);
  EXPECT_EQ(code("LabVIEW Measurement" + std::string(std::size_t{3} << 20, 'x')), Errc::corrupt);
}

}  // namespace
}  // namespace proofmass::io::lvm::lvm_test
