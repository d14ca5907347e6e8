// Third-party LabVIEW measurement files: values from their publishers' own reader.
#include <gtest/gtest.h>

#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::lvm_real_test {
namespace {

std::filesystem::path lvm(const std::string& name) {
  return published_data() / "formats/lvm" / name;
}

TEST(LvmFiles, HaveDecimalCommasInEitherKindOfLine) {
  for (const char* name : {"short.lvm", "short_new_line_end.lvm"}) {
    if (!std::filesystem::exists(lvm(name))) GTEST_SKIP() << absent(lvm(name));
    const auto read = io::read_recording(lvm(name), {});
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->format, "LVM");
    ASSERT_EQ(read->channels.size(), 2u);
    EXPECT_EQ(read->samples(), 10u);
    EXPECT_EQ(read->channels[0].name, "Excitation (Trigger)");
    EXPECT_EQ(read->channels[0].values[0], 0.914018);
    EXPECT_EQ(read->channels[1].unit.symbol, "m/s^2");
    EXPECT_EQ(read->channels[1].values[9], 1.212775);
    EXPECT_DOUBLE_EQ(read->time.rate_hz, 25'600.0);
    // 2013-02-19 09:51:40.727189064
    EXPECT_EQ(read->time.start_ns, 1'361'267'500'727'189'064);
  }
}

TEST(LvmFiles, HaveXValuesAndComments) {
  const auto file = lvm("with_comments.lvm");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file, {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[0].name, "Press\u00e3o ABS. (MPa)");
  EXPECT_EQ(read->channels[0].values[0], 1.833787);
  ASSERT_EQ(read->time.stamps_s.size(), 9u);
  EXPECT_EQ(read->time.stamps_s[1], 0.328878);
  EXPECT_EQ(read->time.stamps_s[8], 9.723275);
}

TEST(LvmFiles, HaveMoreRowsThanTheOnlyHeaderSays) {
  const auto file = lvm("long_single_header_multi_ch.lvm");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file, {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->samples(), 16'384u);
  EXPECT_EQ(read->channels[0].values[0], 0.052530);
  EXPECT_EQ(read->channels[2].values.back(), 0.263686);
  EXPECT_DOUBLE_EQ(read->time.rate_hz, 1.0 / 0.000977);
}

}  // namespace
}  // namespace proofmass::lvm_real_test
