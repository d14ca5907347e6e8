#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

#include "proofmass/io/tdms/tdms_test_support.hpp"

namespace proofmass::io::tdms::tdms_test {
namespace {

using namespace specimen;

constexpr std::uint32_t i16 = 2;

TEST(Tdms, ReadsChannelAfterChannel) {
  const auto read = tdms_or_fail(
      tdms_segment(tdms_whole, two_channels().bytes(), doubles_of({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(read.columns, (Columns{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(read.head.headings, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(read.head.format, "TDMS");
  EXPECT_EQ(read.head.rows, 3u);
  EXPECT_FALSE(read.is_bad());
}

TEST(Tdms, ReadsInterleavedRows) {
  const auto read = tdms_or_fail(tdms_segment(tdms_whole | tdms_interleaved, two_channels().bytes(),
                                              doubles_of({1, 4, 2, 5, 3, 6})));
  EXPECT_EQ(read.columns, (Columns{{1, 2, 3}, {4, 5, 6}}));
}

TEST(Tdms, ReadsBigEndianWithItsContentsLittleEndian) {
  for (const std::uint32_t order : {0U, tdms_interleaved}) {
    const std::vector<double> values =
        order == 0 ? std::vector<double>{1, 2, 3, 4, 5, 6} : std::vector<double>{1, 4, 2, 5, 3, 6};
    const auto read = tdms_or_fail(tdms_segment(tdms_whole | tdms_big_endian | order,
                                                two_channels(Order::big).bytes(),
                                                doubles_of(values, Order::big)));
    EXPECT_EQ(read.columns, (Columns{{1, 2, 3}, {4, 5, 6}}));
  }
}

TEST(Tdms, ReadsEveryTypeOfFigureInBothOrders) {
  for (const Order order : {Order::little, Order::big}) {
    TdmsList list(order);
    std::string data;
    const auto add = [&]<class T>(std::uint32_t type, const std::vector<T>& values) {
      list.channel("/'g'/'" + std::to_string(type) + "'", type, values.size());
      data += bytes_of(values, order);
    };
    add(1, std::vector<std::int8_t>{-128, 127});
    add(2, std::vector<std::int16_t>{-32768, 32767});
    add(3, std::vector<std::int32_t>{INT32_MIN, INT32_MAX});
    add(4, std::vector<std::int64_t>{-(std::int64_t{1} << 53), 5});
    add(5, std::vector<std::uint8_t>{0, 255});
    add(6, std::vector<std::uint16_t>{0, 65535});
    add(7, std::vector<std::uint32_t>{0, UINT32_MAX});
    add(8, std::vector<std::uint64_t>{0, std::uint64_t{1} << 63});
    add(9, std::vector<float>{0.5F, -1.25F});
    add(10, std::vector<double>{0.1, INFINITY});
    add(0x19, std::vector<float>{2.5F, 3.5F});
    add(0x1A, std::vector<double>{1e300, -0.0});
    add(0x21, std::vector<std::uint8_t>{0, 1});
    const std::uint32_t contents = tdms_whole | (order == Order::big ? tdms_big_endian : 0U);
    const auto read = tdms_or_fail(tdms_segment(contents, list.bytes(), data));
    EXPECT_EQ(read.columns, (Columns{{-128, 127},
                                     {-32768, 32767},
                                     {-2147483648.0, 2147483647.0},
                                     {-0x1p53, 5},
                                     {0, 255},
                                     {0, 65535},
                                     {0, 4294967295.0},
                                     {0, 0x1p63},
                                     {0.5, -1.25},
                                     {0.1, INFINITY},
                                     {2.5, 3.5},
                                     {1e300, -0.0},
                                     {0, 1}}));
  }
}

TEST(Tdms, ASegmentRepeatsItsChunkAsOftenAsTheBytesAllow) {
  const auto read = tdms_or_fail(tdms_segment(tdms_whole, two_channels().bytes(),
                                              doubles_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12})));
  EXPECT_EQ(read.columns, (Columns{{1, 2, 3, 7, 8, 9}, {4, 5, 6, 10, 11, 12}}));
}

TEST(Tdms, ASegmentWithoutMetadataIsLikeTheOneBefore) {
  const auto read = tdms_or_fail(
      tdms_segment(tdms_whole, two_channels().bytes(), doubles_of({1, 2, 3, 4, 5, 6})) +
      tdms_segment(tdms_raw_data, "", doubles_of({7, 8, 9, 10, 11, 12})));
  EXPECT_EQ(read.columns, (Columns{{1, 2, 3, 7, 8, 9}, {4, 5, 6, 10, 11, 12}}));
}

TEST(Tdms, AListThatIsNotNewChangesTheOneBefore) {
  std::string file =
      tdms_segment(tdms_whole, two_channels().bytes(), doubles_of({1, 2, 3, 4, 5, 6}));
  // b has two values now, a as many as before.
  file += tdms_segment(tdms_metadata | tdms_raw_data,
                       TdmsList().channel("/'g'/'b'", f64, 2).bytes(), doubles_of({7, 8, 9, 1, 2}));
  // a has none, b still two.
  file += tdms_segment(tdms_metadata | tdms_raw_data, TdmsList().no_values("/'g'/'a'").bytes(),
                       doubles_of({20, 21}));
  // a is present again, at its earlier position in the list, before b.
  file += tdms_segment(tdms_metadata | tdms_raw_data, TdmsList().as_before("/'g'/'a'").bytes(),
                       doubles_of({30, 31, 32, 33, 34}));
  const auto contents = tdms_contents(file);
  ASSERT_TRUE(contents.has_value()) << contents.error().message;
  EXPECT_EQ((*contents)->map.segments, 4u);
  const auto a = tdms_or_fail(file, 0);
  EXPECT_EQ(a.columns, (Columns{{1, 2, 3, 7, 8, 9, 30, 31, 32}, {4, 5, 6, 1, 2, 20, 21, 33, 34}}));
}

TEST(Tdms, ANewListLeavesOthersOut) {
  std::string file =
      tdms_segment(tdms_whole, two_channels().bytes(), doubles_of({1, 2, 3, 4, 5, 6}));
  file += tdms_segment(tdms_whole, TdmsList().as_before("/'g'/'b'").bytes(), doubles_of({7, 8, 9}));
  EXPECT_EQ(tdms_or_fail(file, 0).columns, (Columns{{1, 2, 3}}));
  EXPECT_EQ(tdms_or_fail(file, 1).columns, (Columns{{4, 5, 6, 7, 8, 9}}));
}

TEST(Tdms, DoubledQuotesInPathsAreOne) {
  TdmsList list;
  list.channel("/'Dr. T''s Events'/'it''s'", f64, 1);
  const auto contents = tdms_contents(tdms_segment(tdms_whole, list.bytes(), doubles_of({1})));
  ASSERT_TRUE(contents.has_value());
  EXPECT_EQ((*contents)->groups[0].name, "Dr. T's Events");
  EXPECT_EQ((*contents)->groups[0].headings[0], "it's");
}

TEST(Tdms, InterleavedChannelsMayEndBeforeOthers) {
  TdmsList list;
  list.channel("/'g'/'a'", i16, 1).channel("/'g'/'b'", i16, 3).channel("/'g'/'c'", i16, 2);
  const auto contents = tdms_contents(tdms_segment(tdms_whole | tdms_interleaved, list.bytes(),
                                                   bytes_of<std::int16_t>({1, 2, 3, 4, 5, 6})));
  ASSERT_TRUE(contents.has_value());
  ASSERT_EQ((*contents)->groups.size(), 3u);
  const std::string file = tdms_segment(tdms_whole | tdms_interleaved, list.bytes(),
                                        bytes_of<std::int16_t>({1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(tdms_or_fail(file, 0).columns, (Columns{{1}}));
  EXPECT_EQ(tdms_or_fail(file, 1).columns, (Columns{{2, 4, 6}}));
  EXPECT_EQ(tdms_or_fail(file, 2).columns, (Columns{{3, 5}}));
}

TEST(Tdms, WaveformPropertiesGiveRateStartAndUnit) {
  TdmsList list;
  const std::int64_t start_ns = 1'705'479'286'123'456'789;
  list.channel("/'g'/'a'", f64, 2)
      .property("wf_increment", 0.005)
      .property("wf_start_time", instant_at(start_ns))
      .property("wf_start_offset", 0.25)
      .property("unit_string", "m/s^2");
  const auto read = tdms_or_fail(tdms_segment(tdms_whole, list.bytes(), doubles_of({1, 2})));
  EXPECT_EQ(read.head.rate_hz, 200.0);
  EXPECT_EQ(read.head.start_ns, start_ns + 250'000'000);
  EXPECT_EQ(read.head.headings[0], "a (m/s^2)");
}

TEST(Tdms, AStartIn1904IsNone) {
  TdmsList list;
  list.channel("/'g'/'a'", f64, 1)
      .property("wf_increment", 0.001)
      .property("wf_start_time", Instant{});
  const auto read = tdms_or_fail(tdms_segment(tdms_whole, list.bytes(), doubles_of({1})));
  EXPECT_EQ(read.head.rate_hz, 1000.0);
  EXPECT_FALSE(read.head.start_ns);
}

TEST(Tdms, ASpectrumHasNoRate) {
  TdmsList list;
  list.channel("/'g'/'a'", f64, 1).property("wf_increment", 0.5).property("wf_xunit_string", "Hz");
  EXPECT_FALSE(tdms_or_fail(tdms_segment(tdms_whole, list.bytes(), doubles_of({1}))).head.rate_hz);
}

TEST(Tdms, ALaterSegmentsPropertiesReplaceEarlierOnes) {
  TdmsList first;
  first.channel("/'g'/'a'", f64, 1).property("unit_string", "V").property("wf_increment", 0.1);
  TdmsList second;
  second.as_before("/'g'/'a'").property("unit_string", "g");
  const auto read = tdms_or_fail(tdms_segment(tdms_whole, first.bytes(), doubles_of({1})) +
                                 tdms_segment(tdms_whole, second.bytes(), doubles_of({2})));
  EXPECT_EQ(read.head.headings[0], "a (g)");
  EXPECT_EQ(read.head.rate_hz, 10.0);
}

TEST(Tdms, PointsInTimeAreExactToTheNanosecond) {
  for (const Order order : {Order::little, Order::big}) {
    TdmsList list(order);
    const std::int64_t first = 1'705'479'286'000'000'001;
    list.channel("/'g'/'t'", 0x44, 3).channel("/'g'/'a'", f64, 3);
    std::string data;
    for (const std::int64_t since : {0, 999'999'999, 2'000'000'003})
      data += list.instant(instant_at(first + since));
    data += doubles_of({1, 2, 3}, order);
    const std::uint32_t contents = tdms_whole | (order == Order::big ? tdms_big_endian : 0U);
    const auto read = tdms_or_fail(tdms_segment(contents, list.bytes(), data));
    ASSERT_TRUE(read.head.stamps.has_value());
    EXPECT_EQ(read.head.stamps->column, 0u);
    EXPECT_EQ(read.head.stamps->origin.ns(1.0), first);
    EXPECT_EQ(read.columns, (Columns{{0, 0.999999999, 2.000000003}, {1, 2, 3}}));
  }
}

TEST(Tdms, InstantsComeBackToTheNanosecond) {
  for (const std::int64_t ns :
       {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1}, std::int64_t{999'999'999},
        std::int64_t{-2'082'844'799'999'999'999}, std::int64_t{9'223'372'036'854'775'807}}) {
    EXPECT_EQ(instant_at(ns).unix_ns(), ns);
  }
}

TEST(Tdms, TextIsToldAndPassedOver) {
  TdmsList list;
  list.channel("/'g'/'a'", f64, 2).texts("/'g'/'remarks'", 2, 8 + 3).channel("/'g'/'b'", f64, 2);
  const std::string text = bytes_of<std::uint32_t>({1, 3}) + "xyz";
  const auto read = tdms_or_fail(
      tdms_segment(tdms_whole, list.bytes(), doubles_of({1, 2}) + text + doubles_of({3, 4})));
  EXPECT_EQ(read.columns, (Columns{{1, 2}, {3, 4}}));
  EXPECT_TRUE(read.is_noted("remarks (text, 2 values)")) << read.all_notes();
}

TEST(Tdms, TypesThatAreNotReadAreToldAndPassedOver) {
  struct Type {
    std::uint32_t type;
    std::size_t bytes;
    const char* words;
  };
  for (const auto& [type, bytes, words] :
       {Type{0x08000C, 8, "complex"}, Type{0x10000D, 16, "complex"}, Type{0x0B, 10, "extended"},
        Type{0x0B, 16, "extended"}, Type{0x4F, 8, "fixed-point"}}) {
    for (const std::uint32_t order : {0U, tdms_interleaved}) {
      TdmsList list;
      list.channel("/'g'/'x'", type, 1).channel("/'g'/'b'", f64, 1);
      const auto read = tdms_or_fail(tdms_segment(tdms_whole | order, list.bytes(),
                                                  std::string(bytes, '\1') + doubles_of({3})));
      EXPECT_EQ(read.columns, (Columns{{3}}));
      EXPECT_TRUE(read.is_noted(words)) << read.all_notes();
    }
  }
}

TEST(Tdms, AShortLastChunkOfAWholeSegmentIsSharedEvenly) {
  // 12 values in whole chunks of 6, then 4 in one that is complete but shorter.
  const auto read = tdms_or_fail(tdms_segment(tdms_whole, two_channels().bytes(),
                                              doubles_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10})));
  // 10 = 6 + 4: two of three values of each channel.
  EXPECT_EQ(read.columns, (Columns{{1, 2, 3, 7, 8}, {4, 5, 6, 9, 10}}));
  EXPECT_FALSE(read.is_bad());
}

TEST(Tdms, AHundredThousandSegmentsOfOneValueAreOneRun) {
  TdmsList list;
  list.channel("/'g'/'a'", f64, 1).channel("/'g'/'b'", i16, 1);
  const std::string metadata = list.bytes();
  std::string file;
  constexpr int count = 100'000;
  for (int k = 0; k < count; ++k)
    file += tdms_segment(
        tdms_whole, metadata,
        doubles_of({0.5 * k}) + bytes_of<std::int16_t>({static_cast<std::int16_t>(k % 1000)}));
  const auto contents = tdms_contents(file);
  ASSERT_TRUE(contents.has_value());
  EXPECT_EQ((*contents)->map.runs.size(), 1u);
  const auto read = tdms_or_fail(file, 0, 4096);
  ASSERT_EQ(read.columns[0].size(), 100'000u);
  for (std::size_t k = 0; k < count; ++k) {
    ASSERT_EQ(read.columns[0][k], 0.5 * static_cast<double>(k));
    ASSERT_EQ(read.columns[1][k], static_cast<double>(k % 1000));
  }
  EXPECT_TRUE(read.is_noted("fragmented")) << read.all_notes();
}

TEST(Tdms, ChannelsThatWereWrittenByTurnsAreOneTable) {
  // Segments of varying length, a and b in separate segments.
  std::string file;
  std::vector<double> a;
  std::vector<double> b;
  for (std::uint64_t k = 0; k < 300; ++k) {
    const std::uint64_t n = 1 + k % 7;
    std::vector<double> values(n);
    std::iota(values.begin(), values.end(), 10.0 * static_cast<double>(k));
    file += tdms_segment(tdms_whole, TdmsList().channel("/'g'/'a'", f64, n).bytes(),
                         doubles_of(values));
    a.insert(a.end(), values.begin(), values.end());
    for (double& value : values) value = -value;
    file += tdms_segment(tdms_whole, TdmsList().channel("/'g'/'b'", f64, n).bytes(),
                         doubles_of(values));
    b.insert(b.end(), values.begin(), values.end());
  }
  for (const std::size_t rows_at_once : {1, 13, 5000}) {
    EXPECT_EQ(tdms_or_fail(file, 0, rows_at_once).columns, (Columns{a, b}));
  }
}

TEST(Tdms, RowsBeyondAWindowAreReadAsWritten) {
  // Larger than one read, in each of the possible layouts.
  constexpr std::size_t rows = 70'000;
  std::vector<double> a(rows);
  std::vector<double> b(rows);
  std::vector<double> both;
  for (std::size_t k = 0; k < rows; ++k) {
    a[k] = static_cast<double>(k);
    b[k] = -0.5 * static_cast<double>(k);
    both.insert(both.end(), {a[k], b[k]});
  }
  TdmsList list;
  list.channel("/'g'/'a'", f64, rows).channel("/'g'/'b'", f64, rows);
  const std::string metadata = list.bytes();
  for (const std::size_t rows_at_once : {1000, 65536, 100000}) {
    EXPECT_EQ(tdms_or_fail(tdms_segment(tdms_whole, metadata, doubles_of(a) + doubles_of(b)), 0,
                           rows_at_once)
                  .columns,
              (Columns{a, b}));
    EXPECT_EQ(tdms_or_fail(tdms_segment(tdms_whole | tdms_interleaved, metadata, doubles_of(both)),
                           0, rows_at_once)
                  .columns,
              (Columns{a, b}));
  }
}

TEST(Tdms, ChannelsOfOneGroupAndRateAreATable) {
  TdmsList list;
  list.channel("/'g'/'a'", f64, 2).property("wf_increment", 0.1);
  list.channel("/'g'/'b'", f64, 2).property("wf_increment", 0.2);
  list.channel("/'g'/'c'", f64, 2).property("wf_increment", 0.1);
  list.channel("/'h'/'d'", f64, 2).property("wf_increment", 0.1);
  const auto contents =
      tdms_contents(tdms_segment(tdms_whole, list.bytes(), doubles_of({1, 2, 3, 4, 5, 6, 7, 8})));
  ASSERT_TRUE(contents.has_value());
  std::vector<std::string> names;
  for (const Group& group : (*contents)->groups) names.push_back(group.name);
  EXPECT_EQ(names, (std::vector<std::string>{"g 10 Hz", "g 5 Hz", "h"}));
  EXPECT_EQ((*contents)->groups[0].headings, (std::vector<std::string>{"a", "c"}));
}

TEST(Tdms, SaysWhatTheFileSaysOfItself) {
  TdmsList list;
  list.no_values("/").property("title", "Wheel").property("author", "A. Person");
  list.channel("/'g'/'a'", f64, 1);
  const auto read = tdms_or_fail(tdms_segment(tdms_whole, list.bytes(), doubles_of({1})));
  EXPECT_TRUE(read.is_noted("author: A. Person; title: Wheel")) << read.all_notes();
}

}  // namespace
}  // namespace proofmass::io::tdms::tdms_test
