#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/tdms/reader.hpp"
#include "proofmass/io/tdms/tdms_test_support.hpp"

namespace proofmass::io::tdms::broken_test {
namespace {

using namespace specimen;

constexpr std::uint32_t i32 = 3;

void expect_same(const std::vector<double>& expected, const std::vector<double>& actual) {
  ASSERT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(actual[i])) << i;
    } else {
      EXPECT_EQ(expected[i], actual[i]) << i;
    }
  }
}

const double nan = std::nan("");

TEST(BrokenTdms, WhatAKilledProgramWroteIsReadToTheLastWholeValue) {
  // a complete, b partly, c not at all: still one table.
  TdmsList list;
  for (const char* path : {"/'g'/'a'", "/'g'/'b'", "/'g'/'c'"}) list.channel(path, f64, 3);
  const std::string start =
      tdms_segment(tdms_whole, list.bytes(), doubles_of({1, 2, 3, 4, 5, 6, 7, 8, 9}));
  const std::string file =
      start + tdms_unfinished(tdms_raw_data, "", doubles_of({10, 11, 12, 13}) + "abc");
  const auto read = tdms_or_fail(file);
  ASSERT_EQ(read.columns.size(), 3u);
  expect_same({1, 2, 3, 10, 11, 12}, read.columns[0]);
  expect_same({4, 5, 6, 13, nan, nan}, read.columns[1]);
  expect_same({7, 8, 9, nan, nan, nan}, read.columns[2]);
  EXPECT_TRUE(read.is_bad());
  EXPECT_TRUE(read.is_noted("the file breaks off")) << read.all_notes();
  EXPECT_TRUE(read.is_noted("b 4, c 3")) << read.all_notes();
}

TEST(BrokenTdms, InterleavedChannelsEndTogetherWhereAFileBreaksOff) {
  const std::string file = tdms_unfinished(tdms_whole | tdms_interleaved, two_channels().bytes(),
                                           doubles_of({1, 4, 2, 5}));
  const auto read = tdms_or_fail(file);
  EXPECT_EQ(read.columns, (Columns{{1, 2}, {4, 5}}));
  EXPECT_TRUE(read.is_bad());
}

TEST(BrokenTdms, AFileThatEndsWithAChunkTellsWhetherMoreWasToCome) {
  const std::string metadata = two_channels().bytes();
  const std::string data = doubles_of({1, 2, 3, 4, 5, 6});
  const auto closed_by_nobody = tdms_or_fail(tdms_unfinished(tdms_whole, metadata, data));
  EXPECT_EQ(closed_by_nobody.columns, (Columns{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(closed_by_nobody.is_noted("did not close it"));
  EXPECT_FALSE(closed_by_nobody.is_bad());
  const auto cut = tdms_or_fail(tdms_lead_in(tdms_whole, metadata.size() + 96, metadata.size()) +
                                metadata + data);
  EXPECT_EQ(cut.columns, (Columns{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(cut.is_bad());
}

TEST(BrokenTdms, IndexFilesAreRefusedWithAWord) {
  EXPECT_TRUE(claims("TDSh", ""));
  std::string index = tdms_segment(tdms_whole, two_channels().bytes(), "");
  index[3] = 'h';
  const auto read = tdms_contents(index);
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().code, Errc::unsupported);
  EXPECT_NE(read.error().message.find("index"), std::string::npos);
}

TEST(BrokenTdms, KeepsWhatStandsBeforeTheBreak) {
  const std::string good =
      tdms_segment(tdms_whole, two_channels().bytes(), doubles_of({1, 2, 3, 4, 5, 6}));
  const std::vector<std::string> breaks = {
      "garbage that is no segment at all",
      "TDSm",
      tdms_segment(tdms_whole, TdmsList().as_before("/'g'/'new'").bytes(), doubles_of({1})),
      tdms_segment(tdms_whole,
                   TdmsList().object("/'g'/'new'", bytes_of<std::uint32_t>({99})).bytes(), ""),
      tdms_lead_in(tdms_whole, 8, 9) + std::string(8, '\0'),
      tdms_lead_in(tdms_whole, 8, 8) + bytes_of<std::uint32_t>({1000, 1000}),
  };
  for (const std::string& broken : breaks) {
    const auto read = tdms_or_fail(good + broken);
    EXPECT_EQ(read.columns, (Columns{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_TRUE(read.is_bad());
    EXPECT_TRUE(read.is_noted("byte ")) << read.all_notes();
    EXPECT_FALSE(tdms_contents(broken).has_value());
  }
}

TEST(BrokenTdms, CountsThatNoFileCanHoldAreNoReasonToAllocate) {
  for (const std::uint64_t count :
       {~std::uint64_t{0}, std::uint64_t{1} << 61, std::uint64_t{1} << 40}) {
    for (const std::uint32_t order : {0U, tdms_interleaved}) {
      TdmsList list;
      list.channel("/'g'/'a'", i32, count).channel("/'g'/'b'", i32, count);
      const auto read = read_tdms(
          tdms_segment(tdms_whole | order, list.bytes(), bytes_of<std::int32_t>({1, 2, 3, 4})));
      if (read) {
        EXPECT_LE(read->columns[0].size(), 4u);
      }
    }
    TdmsList list;
    list.daqmx("/'g'/'a'", count, {list.scaler(3, 0, 0, 0)}, {0xFFFFFFFF});
    const auto read =
        read_tdms(tdms_segment(tdms_whole | tdms_daqmx, list.bytes(), std::string(10, 'x')));
    if (read) {
      EXPECT_LE(read->columns[0].size(), 1u);
    }
  }
}

TEST(BrokenTdms, RefusesWhatHoldsNothing) {
  EXPECT_EQ(tdms_contents("TDSm").error().code, Errc::corrupt);
  EXPECT_EQ(
      tdms_contents(tdms_segment(tdms_whole, TdmsList().no_values("/").bytes(), "")).error().code,
      Errc::too_few_samples);
  EXPECT_EQ(tdms_contents(tdms_segment(tdms_whole, two_channels().bytes(), "")).error().code,
            Errc::too_few_samples);
}

TEST(BrokenTdms, BrokenOffAtEveryByteNothingIsInvented) {
  TdmsList list = two_channels();
  list.property("wf_increment", 0.1).property("unit_string", "g");
  std::string whole = tdms_segment(tdms_whole, list.bytes(), doubles_of({1, 2, 3, 4, 5, 6}));
  whole += tdms_segment(tdms_raw_data, "", doubles_of({7, 8, 9, 10, 11, 12}));
  whole += tdms_segment(tdms_whole | tdms_interleaved, list.bytes(),
                        doubles_of({13, 16, 14, 17, 15, 18}));
  const Columns all{{1, 2, 3, 7, 8, 9, 13, 14, 15}, {4, 5, 6, 10, 11, 12, 16, 17, 18}};
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto read = read_tdms(whole.substr(0, size));
    if (!read) continue;
    const std::size_t lead_ins[] = {list.bytes().size() + 28 + 48,
                                    list.bytes().size() + 2 * (28 + 48)};
    const bool is_between = size == lead_ins[0] || size == lead_ins[1];
    ASSERT_EQ(read->is_bad(), !is_between) << size;
    for (std::size_t c = 0; c < read->columns.size(); ++c) {
      for (std::size_t k = 0; k < read->columns[c].size(); ++k) {
        if (!std::isnan(read->columns[c][k])) {
          ASSERT_EQ(read->columns[c][k], all[c][k]) << size << " " << c << " " << k;
        }
      }
    }
  }
}

}  // namespace
}  // namespace proofmass::io::tdms::broken_test
