#include <gtest/gtest.h>
#include <limits>
#include <utility>
#include <vector>

#include "proofmass/thesis/static_bias.hpp"

namespace proofmass::thesis::static_record_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

StaticRecord record_of(double rate_hz, std::vector<double> samples) {
  return static_record("still.csv", rate_hz, 3.0,
                       {{.name = "x", .accel_mps2 = std::move(samples)}});
}

std::vector<double> ramp(std::size_t samples) {
  std::vector<double> values(samples);
  for (std::size_t k = 0; k < samples; ++k) values[k] = static_cast<double>(k);
  return values;
}

TEST(StaticRecord, OfAKilohertzIsMeansOverTwentyFiveAndOneSampleOfEach) {
  const StaticRecord record = record_of(1000.0, ramp(1010));
  EXPECT_EQ(record.decimation, 25U);
  EXPECT_EQ(record.rate_hz, 40.0);
  EXPECT_DOUBLE_EQ(record.since_switch_on_s, 3.012);  // centre of the first 25
  ASSERT_EQ(record.axes[0].accel_mps2.size(), 40U);   // the last ten samples are an incomplete
                                                      // block
  EXPECT_EQ(record.axes[0].accel_mps2[39], 987.0);
  EXPECT_EQ(record.axes[0].picked_mps2[39], 975.0);
  EXPECT_FALSE(record.simulated);
}

TEST(StaticRecord, OfFewSamplesASecondStaysAsItIs) {
  const StaticRecord record = record_of(50.0, ramp(100));
  EXPECT_EQ(record.decimation, 1U);
  EXPECT_EQ(record.axes[0].accel_mps2, ramp(100));
  EXPECT_TRUE(record.axes[0].picked_mps2.empty());
  EXPECT_EQ(record.since_switch_on_s, 3.0);
}

TEST(StaticRecord, KeepsHalfAMillionValuesAtMost) {
  const StaticRecord record = record_of(50.0, ramp(1'200'000));
  EXPECT_EQ(record.decimation, 3U);
  EXPECT_EQ(record.axes[0].accel_mps2.size(), 400'000U);
}

TEST(StaticRecord, TakesTheMeanOfWhatIsThereAndNoneWhereHalfIsMissing) {
  std::vector<double> samples(8, 1.0);
  samples[1] = nan;
  samples[2] = std::numeric_limits<double>::infinity();
  samples[4] = samples[5] = nan;
  samples[3] = 4.0;
  const StaticRecord record = record_of(160.0, samples);
  ASSERT_EQ(record.decimation, 4U);
  EXPECT_TRUE(std::isnan(record.axes[0].accel_mps2[0]));  // 2 of 4 samples are missing
  EXPECT_TRUE(std::isnan(record.axes[0].accel_mps2[1]));
  samples[1] = 1.0;
  EXPECT_EQ(record_of(160.0, samples).axes[0].accel_mps2[0], 2.0);  // mean of 1, 1 and 4
}

}  // namespace
}  // namespace proofmass::thesis::static_record_test
