#include "proofmass/signal/resample/stamp_band.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/recording.hpp"
#include "proofmass/signal/even_grid.hpp"

namespace proofmass::signal::stamp_band_test {
namespace {

/// Stamps of samples 0, 1, … except those missing, in whole ticks.
std::vector<double> whole_ticks(std::size_t samples,
                                double step,
                                const std::vector<std::size_t>& missing) {
  std::vector<double> out;
  for (std::size_t n = 0; n < samples; ++n)
    if (std::ranges::find(missing, n) == missing.end())
      out.push_back(std::floor(static_cast<double>(n) * step + 0.3));
  return out;
}

TEST(StampBand, CountsMissingRowsBesideRounding) {
  for (const double step : {0.625, 0.8, 1.05, 1.2, 1.43, 1.5}) {
    const std::vector<double> stamps =
        whole_ticks(4000, step, {700, 1501, 1502, 1503, 2600, 2601, 3300});
    EXPECT_EQ(numbers_in_band(stamps, step, 1.0).back(), 3999.0) << step;
    EXPECT_EQ(numbers_in_band(whole_ticks(4000, step, {}), step, 1.0).back(), 3999.0) << step;
  }
}

TEST(StampBand, TakesNoStampThatIsLateForMissingRows) {
  std::vector<double> stamps = whole_ticks(4000, 1.2, {});
  for (std::size_t k = 100; k < 4000; k += 97) stamps[k] += 3.0;
  EXPECT_EQ(numbers_in_band(stamps, 1.2, 1.0).back(), 3999.0);
}

TEST(StampBand, FollowsAClockThatDrifts) {
  std::vector<double> stamps;
  for (int k = 0; k < 50'000; ++k) stamps.push_back(std::floor(1.2 * k + 5.0 * std::sin(2e-5 * k)));
  EXPECT_EQ(numbers_in_band(stamps, 1.2, 1.0).back(), 49'999.0);
}

TEST(StampBand, TellsMissingPacketsFromPackets) {
  std::vector<double> stamps;
  for (int k = 0; k < 6000; ++k)
    if (k < 3000 || k >= 3080) stamps.push_back(16.0 * std::floor(k / 16.0));
  EXPECT_NEAR(numbers_in_band(stamps, 1.0, 16.0).back(), 5999.0, 16.0);
}

// If one more row does not change the number, counting rows would not terminate.
TEST(StampBand, EndsWhereAStampJumpsBeyondAllRows) {
  std::vector<double> stamps = whole_ticks(100, 1.2, {});
  stamps.push_back(1e20);
  stamps.push_back(1e20);
  EXPECT_GT(numbers_in_band(stamps, 1.2, 1.0).back(), 1e19);
}

TEST(StampBand, GivesTheGridItsHoles) {
  TimeBase time;
  time.source = TimeSource::stamps;
  time.rate_hz = 1.0 / 1.2;
  time.band_s = 1.0;
  time.stamps_s = whole_ticks(4000, 1.2, {2000, 2001});
  const auto grid = even_grid(time, time.stamps_s.size());
  ASSERT_TRUE(grid.has_value());
  EXPECT_EQ(grid->missing, 2U);
  ASSERT_EQ(grid->holes.size(), 1U);
  EXPECT_NEAR(static_cast<double>(grid->holes[0].before), 2000.0, 8.0);
}

}  // namespace
}  // namespace proofmass::signal::stamp_band_test
