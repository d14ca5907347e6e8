#include "proofmass/signal/running_grid.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace proofmass::signal::running_grid_test {
namespace {

struct Laid {
  std::vector<std::vector<double>> channels;
  std::size_t largest_piece = 0;

  [[nodiscard]] GridSink sink() {
    return [this](std::span<const View<double>> piece) {
      channels.resize(piece.size());
      for (std::size_t c = 0; c < piece.size(); ++c)
        channels[c].insert(channels[c].end(), piece[c].begin(), piece[c].end());
      largest_piece = std::max(largest_piece, piece[0].size());
    };
  }
};

TimeBase base_of(std::vector<double> stamps_s) {
  TimeBase time;
  time.source = TimeSource::stamps;
  time.rate_hz = 100.0;
  time.stamps_s = std::move(stamps_s);
  return time;
}

Block block_of(const TimeBase& time,
               const std::vector<std::vector<double>>& channels,
               std::size_t from,
               std::size_t rows) {
  Block block;
  block.first = from;
  for (const auto& channel : channels)
    block.channels.push_back(View<double>(channel).subspan(from, rows));
  if (!time.is_uniform()) block.stamps_s = View<double>(time.stamps_s).subspan(from, rows);
  return block;
}

void expect_equal(View<double> a, View<double> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    ASSERT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k]))) << k;
}

TEST(RunningEvenGrid, LaysEachSampleWhereTheWholeRecordingHasIt) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform;
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const auto n = static_cast<std::size_t>(3000.0 * uniform(random)) + 1;
    const double often = 0.2 * uniform(random), scatter = 0.4 * uniform(random);
    const double stalls = 0.01 * uniform(random);
    std::vector<double> stamps_s;
    std::vector<std::vector<double>> channels(2);
    for (double s = 0.0; stamps_s.size() < n;) {
      stamps_s.push_back(s);
      s += 0.01 * (1.0 + scatter * (uniform(random) - 0.5));
      if (uniform(random) < often) s += 0.01 * std::floor(6.0 * uniform(random) - 1.0);
      if (uniform(random) < stalls) s += 0.01 * std::floor(300.0 * uniform(random));
      channels[0].push_back(uniform(random) < 0.1 ? 3e34 : uniform(random));
      channels[1].push_back(static_cast<double>(stamps_s.size()));
    }
    if (trial % 3 == 0)  // rows that were late, and stamped together
      for (std::size_t k = 100; k + 50 < n; k += 400)
        std::fill_n(stamps_s.begin() + static_cast<std::ptrdiff_t>(k), 50, stamps_s[k + 50]);
    const TimeBase time = base_of(stamps_s);
    RunningEvenGrid running(time, 2);
    Laid laid;
    for (std::size_t from = 0, rows = 0; from < n; from += rows) {
      rows = std::min(n - from,
                      static_cast<std::size_t>((trial % 2 == 0 ? 5.0 : 2000.0) * uniform(random)));
      ASSERT_TRUE(running.add(block_of(time, channels, from, rows), laid.sink()));
    }
    const auto grid = running.finish(laid.sink());
    const auto whole = even_grid(time, n);
    ASSERT_EQ(grid.has_value(), whole.has_value());
    if (!grid) continue;
    EXPECT_EQ(grid->rate_hz, whole->rate_hz);
    EXPECT_EQ(grid->recorded, n);
    EXPECT_EQ(grid->missing, whole->missing);
    EXPECT_EQ(grid->relative_jitter, whole->relative_jitter);
    EXPECT_EQ(grid->holes.size(), whole->holes.size());
    EXPECT_EQ(running.hole_count(), whole->holes.size());
    for (std::size_t c = 0; c < 2; ++c)
      expect_equal(laid.channels[c], on_even_grid(channels[c], *whole));
  }
}

TEST(RunningEvenGrid, PassesSamplesOnAtOnceUnlessAHoleIsInQuestion) {
  std::vector<double> stamps_s;
  for (int k = 0; k < 60; ++k) stamps_s.push_back(0.01 * (k < 30 ? k : k + 4));
  const TimeBase time = base_of(stamps_s);
  const std::vector<std::vector<double>> channels{stamps_s};
  RunningEvenGrid running(time, 1);
  Laid laid;
  ASSERT_TRUE(running.add(block_of(time, channels, 0, 30), laid.sink()));
  EXPECT_EQ(laid.channels[0].size(), 30U);
  ASSERT_TRUE(running.add(block_of(time, channels, 30, 5), laid.sink()));
  EXPECT_EQ(laid.channels[0].size(), 30U) << "it may yet turn out to be a late stamp";
  ASSERT_TRUE(running.add(block_of(time, channels, 35, 4), laid.sink()));
  EXPECT_EQ(laid.channels[0].size(), 43U);
}

TEST(RunningEvenGrid, OfAUniformBaseIsTheSamplesThemselves) {
  TimeBase time;
  time.rate_hz = 50.0;
  const std::vector<std::vector<double>> channels{{1.0, 2.0, std::nan(""), 4.0}};
  RunningEvenGrid running(time, 1);
  Laid laid;
  ASSERT_TRUE(running.add(block_of(time, channels, 0, 4), laid.sink()));
  const auto grid = running.finish(laid.sink());
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->recorded, 4U);
  EXPECT_EQ(grid->rate_hz, 50.0);
  expect_equal(laid.channels[0], channels[0]);
}

TEST(RunningEvenGrid, HandsALongHoleOverInSmallPieces) {
  std::vector<double> stamps_s;
  std::vector<std::vector<double>> channels(1);
  for (int k = 0; k < 60'000; ++k) {
    stamps_s.push_back(0.01 * k + (k >= 5 ? 1000.0 : 0.0));
    channels[0].push_back(k);
  }
  const TimeBase time = base_of(stamps_s);
  RunningEvenGrid running(time, 1);
  Laid laid;
  ASSERT_TRUE(running.add(block_of(time, channels, 0, 100), laid.sink()));
  ASSERT_TRUE(running.add(block_of(time, channels, 100, 59'900), laid.sink()));
  ASSERT_TRUE(running.finish(laid.sink()));
  EXPECT_EQ(laid.channels[0].size(), 160'000U);
  EXPECT_LE(laid.largest_piece, 4096U);
}

TEST(RunningEvenGrid, RefusesStampsThatLeaveMoreOutThanThereIs) {
  const TimeBase few = base_of({0.0, 0.01, 0.02, 7200.0, 7200.01});
  const std::vector<std::vector<double>> channels{std::vector<double>(5, 1.0)};
  RunningEvenGrid running(few, 1);
  Laid laid;
  ASSERT_TRUE(running.add(block_of(few, channels, 0, 5), laid.sink()));
  EXPECT_EQ(running.finish(laid.sink()).error().code, Errc::corrupt);

  const TimeBase years = base_of({0.0, 0.01, 1e9, 1e9 + 0.01, 1e9 + 0.02, 1e9 + 0.03, 1e9 + 0.04,
                                  1e9 + 0.05, 1e9 + 0.06, 1e9 + 0.07, 1e9 + 0.08, 1e9 + 0.09});
  const std::vector<std::vector<double>> more{std::vector<double>(12, 1.0)};
  RunningEvenGrid patient(years, 1);
  EXPECT_FALSE(patient.add(block_of(years, more, 0, 12), laid.sink()))
      << "nobody waits for 10^11 samples of nothing";
}

}  // namespace
}  // namespace proofmass::signal::running_grid_test
