#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::tdms_real_test {
namespace {

std::filesystem::path specimen(const char* name) {
  return published_data() / "formats/tdms" / name;
}

TEST(PublishedTdms, TheBigEndianExampleOfLabviewIsRead) {
  const auto file = specimen("big_endian.tdms");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file.string(), {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  const Channel* sweep = read->find("Phase sweep");
  ASSERT_NE(sweep, nullptr);
  ASSERT_GE(sweep->values.size(), 3u);
  EXPECT_EQ(sweep->values[0], 0.0);
  EXPECT_NEAR(sweep->values[1], 0.0634176, 5e-8);
  EXPECT_NEAR(sweep->values[2], 0.1265799, 5e-8);
  EXPECT_EQ(read->time.rate_hz, 1000.0);
  EXPECT_EQ(read->samples(), 3500u);
  EXPECT_FALSE(read->time.start_ns.has_value());  // 1904 means not set
}

TEST(PublishedTdms, AWaveformWithItsStartIsReadAsItStands) {
  const auto file = specimen("raw_timestamps.tdms");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file.string(), {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->samples(), 128u);
  EXPECT_EQ(read->time.rate_hz, 1000.0);
  // One period of a sine in 128 samples.
  for (std::size_t k = 0; k < 128; ++k)
    EXPECT_NEAR(read->channels[0].values[k],
                std::sin(std::numbers::pi * static_cast<double>(k) / 64.0), 1e-12);
  // 0xE1D61CFB seconds since 1904 plus 0x1190B8 / 2^24 s.
  EXPECT_EQ(read->time.start_ns, (std::int64_t{0xE1D61CFB} - 2'082'844'800) * 1'000'000'000 +
                                     std::llround(0x1190B8 / 16777216.0 * 1e9));
}

}  // namespace
}  // namespace proofmass::tdms_real_test
