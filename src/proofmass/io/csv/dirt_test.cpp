#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::csv_dirt_test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(CsvReader, KeepsNanWhereTheFileHasNoNumber) {
  const auto read =
      read_text("t,a,b\n0,NaN,1\n1,,2\n2,NULL,3\n3,#N/A,4\n4,nan,5\n5,-,6\n6,1.5,7\n");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->samples(), 7u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_TRUE(std::isnan(read->channels[0].values[k])) << k;
  EXPECT_EQ(read->channels[0].values[6], 1.5);
  EXPECT_EQ(read->channels[1].values.back(), 7.0);
}

TEST(CsvReader, KeepsInfinitiesAbsurdSizesAndDenormals) {
  const auto read =
      read_text("t,a\n0,inf\n1,-Inf\n2,+Infinity\n3,3.4028e34\n4,1.4e-45\n5,5e-324\n6,1\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->channels[0].values,
            (std::vector<double>{inf, -inf, inf, 3.4028e34, 1.4e-45, 5e-324, 1.0}));
}

TEST(CsvReader, ReadsNoHexadecimals) {
  const auto read = read_text("t,a\n0,1\n1,0x10\n2,3\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(std::isnan(read->channels[0].values[1]));
  EXPECT_TRUE(is_noted(*read, "a: 1 field is not a number, the first \"0x10\" on line 3"))
      << notes_of(*read);
}

TEST(CsvReader, LeavesFurtherColumnsOfWordsOutAndNamesThem) {
  const auto read = read_text("part,who,t,a,b,c\nx_a,I,0,1,2,3\nx_a,you,1,2,3,4\nx_p,I,2,3,4,5\n");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[0].values, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(is_noted(*read, "who: left out"));
}

TEST(CsvReader, FillsShortRowsAndPassesOverExcess) {
  const auto read = read_text("t,a,b\n0,1,2\n1,3\n2,4,5,6,7\n3,8,9\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(std::isnan(read->channels[1].values[1]));
  EXPECT_EQ(read->channels[1].values[2], 5.0);
  EXPECT_TRUE(is_noted(*read, "line 3 too short"));
  EXPECT_TRUE(is_noted(*read, "line 4 too long"));
}

TEST(CsvReader, PassesOverLinesWithoutANumber) {
  const auto read = read_text("t,a\n0,1\n1,2\n*** restart ***\nt,a\n2,3\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->channels[0].values, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(is_noted(*read, "2 lines, the first 4, without a number")) << notes_of(*read);
  EXPECT_EQ(read->first_line, 0u) << "lines and samples are out of step";
}

TEST(CsvReader, DoesNotTrustTheLastFieldOfALineThatBrokeOff) {
  const auto read = read_text("t,a,b\n0,1.25,2.25\n1,3.25,4.25\n2,5.2");
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->samples(), 3u);
  EXPECT_TRUE(std::isnan(read->channels[0].values[2]));
  EXPECT_TRUE(std::isnan(read->channels[1].values[2]));
  EXPECT_TRUE(is_noted(*read, "line 4 breaks off"));
}

TEST(CsvReader, KeepsAWholeLastLineWithoutItsEnd) {
  const auto read = read_text("t,a,b\n0,1,2\n1,3,4");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->channels[1].values, (std::vector<double>{2, 4}));
  EXPECT_FALSE(is_noted(*read, "breaks off"));
}

TEST(CsvReader, ReadsUpToTheZerosThatAPowerCutLeft) {
  for (const std::size_t zeros : {1u, 5000u, 20'000'000u}) {
    const auto read = read_text("t,a,b\n0,1,2\n1,3,4\n2,5" + std::string(zeros, '\0'));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    ASSERT_EQ(read->samples(), 3u);
    EXPECT_TRUE(std::isnan(read->channels[0].values[2]));
    EXPECT_TRUE(is_noted(*read, "bytes of zero")) << notes_of(*read);
  }
}

TEST(CsvReader, ReadsOnBehindZeros) {
  const auto read =
      read_text("t,a,b\n0,1,2\n1,3,4\n2,5" + std::string(700, '\0') + "3,7,8\n4,9,10\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->channels[1].values.back(), 10.0);
  EXPECT_EQ(read->channels[0].values[read->samples() - 2], 7.0);
}

TEST(CsvReader, RefusesWhatIsNoTable) {
  EXPECT_EQ(read_text("").error().code, Errc::too_few_samples);
  EXPECT_EQ(read_text("\n \n").error().code, Errc::too_few_samples);
  EXPECT_EQ(read_text("t,a,b\n").error().code, Errc::too_few_samples);
  EXPECT_EQ(read_text("Dear reader,\nthis is a letter.\nYours\n").error().code,
            Errc::too_few_samples);
  EXPECT_EQ(read_text(std::string("\x01\x02\x03\x04\x05\x06\x07\x08", 8)).error().code,
            Errc::corrupt);
  EXPECT_EQ(read_text("{\"a\": 1}").error().code, Errc::unsupported);
}

TEST(CsvReader, SaysInOneLineWhichFileItCouldNotRead) {
  const auto missing = read_recording("/no/such/file.csv", {});
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, Errc::unreadable);
  EXPECT_TRUE(missing.error().message.starts_with("/no/such/file.csv: "));
  EXPECT_EQ(missing.error().message.find('\n'), std::string::npos);
}

TEST(CsvReader, RefusesEndlessLinesAndCountlessColumns) {
  const auto endless = read_text("1,2\n1,2\n1,2\n" + std::string(std::size_t{20} << 20, '7'));
  ASSERT_FALSE(endless.has_value());
  EXPECT_EQ(endless.error().code, Errc::corrupt);
  EXPECT_NE(endless.error().message.find("line 4"), std::string::npos) << endless.error().message;
  std::string wide;
  for (int i = 0; i < 200'000; ++i) wide += "1,";
  EXPECT_EQ(read_text(wide + "\n" + wide + "\n").error().code, Errc::corrupt);
}

TEST(CsvReader, ReadsThousandsOfColumns) {
  std::string text;
  for (int row = 0; row < 20; ++row) {
    for (int c = 0; c < 5000; ++c) text += std::to_string(row * 10'000 + c) + ",";
    text += "\n";
  }
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_GE(read->channels.size(), 4999u);
  EXPECT_EQ(read->channels.back().values.back(), 194'999.0);
}

TEST(CsvReader, KeepsTheChannelsAskedFor) {
  const auto read = read_text("t,a,b,c\n0,1,2,3\n1,4,5,6\n2,7,8,9\n", {.channels = {"C", "a"}});
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->channels.size(), 2u);
  EXPECT_EQ(read->channels[0].name, "a");
  EXPECT_EQ(read->channels[1].name, "c");
  const auto none = read_text("t,a\n0,1\n1,4\n", {.channels = {"q"}});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, Errc::invalid_argument);
  EXPECT_NE(none.error().message.find("it has a"), std::string::npos);
}

TEST(CsvReader, TellsHowFarItIs) {
  std::string text = "t,a\n";
  for (int k = 0; k < 200'000; ++k) text += std::to_string(k) + ",1.5\n";
  std::vector<double> fractions;
  const auto read = read_text(text, {.progress = [&](std::string_view, double fraction) {
                                fractions.push_back(fraction);
                              }});
  ASSERT_TRUE(read.has_value());
  ASSERT_GT(fractions.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(CsvReader, ReadsRowsAcrossTheEdgesOfItsPieces) {
  std::string text = "t,a,b\n";
  const int rows = 150'000;
  for (int k = 0; k < rows; ++k)
    text += std::to_string(k * 0.01) + "," + std::to_string(k) + (k % 7 == 0 ? ",\n" : ",2\n");
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->samples(), static_cast<std::size_t>(rows));
  for (int k = 0; k < rows; ++k) {
    const auto i = static_cast<std::size_t>(k);
    ASSERT_EQ(read->channels[0].values[i], k);
    ASSERT_EQ(std::isnan(read->channels[1].values[i]), k % 7 == 0);
  }
}

}  // namespace
}  // namespace proofmass::io::csv_dirt_test
