#include <algorithm>
#include <gtest/gtest.h>
#include <zlib.h>

#include "proofmass/io/matlab/mat_specimens.hpp"
#include "proofmass/io/numpy/npz_reader.hpp"
#include "proofmass/io/numpy/npz_specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::npz_test {
namespace {

using namespace specimen;
using Values = std::vector<double>;

ReadOptions chosen(std::string name) {
  ReadOptions options;
  options.variables = {std::move(name)};
  return options;
}

/// first, first + 1, …
std::string counted(int count, double first) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first + k);
  return bytes_of(values);
}

const std::string rate = npy_file("<f8", "()", bytes_of<double>({50}));

TEST(Npz, ReadsTheLargestTableWithTheVectorsBesideIt) {
  std::string time;
  for (int k = 0; k < 30; ++k) time += bytes_of<double>({2.0 + k / 50.0});
  const auto read = read_text(zip({{"acc.npy", npy_file("<f8", "(30, 3)", counted(90, 0))},
                                   {"t.npy", npy_file("<f8", "(30,)", time)},
                                   {"other.npy", npy_file("<f8", "(7,)", counted(7, 0))}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "npz");
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->samples(), 30u);
  EXPECT_EQ(read->channels[1].values[2], 7.0);
  EXPECT_EQ(read->time.channel, "t");
  EXPECT_NEAR(read->time.rate_hz, 50.0, 1e-9);
  EXPECT_TRUE(is_noted(*read, "acc (30 x 3 float64)")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "other (7 x 1 float64)"));
}

TEST(Npz, ReadsPackedArraysToo) {
  const auto read = read_text(
      zip({{"fs.npy", rate}, {"x.npy", npy_file("<f8", "(3000,)", counted(3000, 5))}}, true));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.rate_hz, 50.0);
  EXPECT_EQ(read->channels[0].name, "x");
  EXPECT_EQ(read->samples(), 3000u);
  EXPECT_EQ(read->channels[0].values[2999], 3004.0);
}

TEST(Npz, EitherOrderAndEitherDirectionGiveTheSameTable) {
  // Row k is {9 - k, 10 + k}, in each of the four possible layouts.
  std::string rows;
  std::string columns;
  for (int k = 0; k < 8; ++k)
    rows += bytes_of<std::int16_t>(
        {static_cast<std::int16_t>(9 - k), static_cast<std::int16_t>(10 + k)});
  for (int c = 0; c < 2; ++c)
    for (int k = 0; k < 8; ++k)
      columns += bytes_of<std::int16_t>({static_cast<std::int16_t>(c == 0 ? 9 - k : 10 + k)});
  for (const std::string& array :
       {npy_file("<i2", "(8, 2)", rows), npy_file("<i2", "(8, 2)", columns, true),
        npy_file("<i2", "(2, 8)", columns), npy_file("<i2", "(2, 8)", rows, true)}) {
    const auto read = read_text(zip({{"gyro.npy", array}}));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    ASSERT_EQ(read->channels.size(), 2u);
    EXPECT_EQ(read->channels[0].values, (Values{9, 8, 7, 6, 5, 4, 3, 2}));
    EXPECT_EQ(read->channels[1].values, (Values{10, 11, 12, 13, 14, 15, 16, 17}));
  }
}

TEST(Npz, ReadsTheArrayThatIsAskedFor) {
  const std::string file = zip(
      {{"imu/acc.npy", npy_file("<f8", "(30, 3)", counted(90, 0))},
       {"imu/temp.npy", npy_file("<f4", "(9,)", bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8, 9}))}});
  const auto read = read_text(file, chosen("imu/temp"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].name, "temp");
  EXPECT_EQ(read->samples(), 9u);
  EXPECT_EQ(read_text(file, chosen("gyro")).error().code, Errc::invalid_argument);
}

TEST(Npz, FieldsOfAStructuredArrayAreVariables) {
  std::string rows;
  for (std::uint32_t k = 0; k < 20; ++k)
    rows += bytes_of<std::uint32_t>({10 * k}) + "ab" +
            bytes_of<float>({1.F, 2.F, static_cast<float>(k)});
  const auto read = read_text(zip(
      {{"log.npy", npy_text("{'descr': [('t_ms', '<u4'), ('tag', '|S2'), ('acc', '<f4', (3,))], "
                            "'fortran_order': False, 'shape': (20,), }",
                            rows)}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u) << notes_of(*read);
  EXPECT_EQ(read->channels[2].values[19], 19.0);
  EXPECT_EQ(read->time.rate_hz, 100.0);
}

TEST(Npz, KeepsTheRowsOfAnArrayThatBreaksOff) {
  const auto read = read_text(zip({{"a.npy", npy_file("<f8", "(9,)", counted(5, 0))},
                                   {"b.npy", npy_file("<f8", "(9,)", counted(9, 0))}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 5u);
  EXPECT_TRUE(is_noted(*read, "breaks off after 5 of 9 samples"));
}

TEST(Npz, LeavesOutWhatIsNoTable) {
  const auto read = read_text(zip({{"a.npy", npy_file("<f8", "(9,)", counted(9, 0))},
                                   {"bad.npy", "no array at all"},
                                   {"many.npy", npy_file("<f8", "(4294967296, 4294967296)", "")},
                                   {"none.npy", npy_file("<f8", "(0,)", "")},
                                   {"words.npy", npy_file("<U4", "(2,)", std::string(32, 'a'))}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels.size(), 1u);
  EXPECT_TRUE(is_noted(*read, "none (empty)")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "many (the .npy header claims more")) << notes_of(*read);
  EXPECT_EQ(read_text(zip({{"none.npy", npy_file("<f8", "(0,)", "")}})).error().code,
            Errc::too_few_samples);
}

TEST(Npz, BrokenOffAnywhereIsReadOrRefused) {
  const std::string whole =
      zip({{"acc.npy", npy_file("<f8", "(6, 3)", counted(18, 0))},
           {"t.npy", npy_file("<f4", "(6,)", bytes_of<float>({0, 1, 2, 3, 4, 5}))},
           {"fs.npy", rate}},
          true);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto read = read_text(whole.substr(0, size));
    if (read) continue;
    ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
    ASSERT_TRUE(read.error().message.starts_with("text: ")) << read.error().message;
  }
}

// Truncated arrays within an intact archive.
TEST(Npz, ArraysBrokenOffAnywhereAreReadOrRefused) {
  for (const bool fortran : {false, true}) {
    const std::string whole = npy_file("<f8", "(6, 3)", counted(18, 0), fortran);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto read = read_text(zip({{"a.npy", whole.substr(0, size)}}));
      ASSERT_TRUE(!read || read->samples() < 6) << size;
    }
  }
}

TEST(Npz, IsKnownByItsFirstFileOrItsName) {
  const std::string array = npy_file("<f8", "(2,)", counted(2, 0));
  EXPECT_TRUE(claims_npz(zip({{"a.npy", array}}), "x.zip"));
  EXPECT_TRUE(claims_npz(zip({{"a.csv", array}}), "x.npz"));
  EXPECT_FALSE(claims_npz(zip({{"a.csv", array}}), "x.zip"));
  EXPECT_FALSE(claims_npz("PK\x03\x04", "x.npz"));
}

}  // namespace
}  // namespace proofmass::io::npz_test
