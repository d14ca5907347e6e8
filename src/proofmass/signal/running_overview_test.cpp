#include "proofmass/signal/running_overview.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::signal::running_overview_test {
namespace {

Recording head_of(double rate_hz) {
  Recording head;
  head.time.source = TimeSource::given_rate;
  head.time.rate_hz = rate_hz;
  head.channels.push_back({"x", *parse_unit("g"), {}});
  return head;
}

TEST(RunningOverview, KeepsEverySpikeOfAMillionSamplesInAFewThousand) {
  std::vector<double> x(1'000'000);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::sin(1e-3 * static_cast<double>(k));
  x[123'456] = 7.0;
  x[999'999] = -8.0;
  x[500'000] = 3e34;
  RunningOverview overview(1);
  constexpr std::size_t block = 1000;
  for (std::size_t first = 0; first < x.size(); first += block)
    overview.add(
        {.first = first, .channels = {View<double>(x).subspan(first, block)}, .stamps_s = {}});
  const Recording picture = overview.finish(head_of(100.0));
  const Samples& values = picture.channels[0].values;
  ASSERT_EQ(values.size(), picture.time.stamps_s.size());
  EXPECT_LE(values.size(), 2u * 4096u);
  EXPECT_GE(values.size(), 4096u);
  EXPECT_EQ(*std::ranges::max_element(values), 7.0);
  EXPECT_EQ(*std::ranges::min_element(values), -8.0);
  const auto spike = std::ranges::max_element(values) - values.begin();
  const double span_s = static_cast<double>(overview.span()) / 100.0;
  EXPECT_NEAR(picture.time.stamps_s[static_cast<std::size_t>(spike)], 1234.56, span_s);
}

TEST(RunningOverview, IsTheSameHoweverTheRecordingIsCut) {
  std::vector<double> x(70'001);
  std::vector<double> stamps_s(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = std::cos(0.7 * static_cast<double>(k)) * static_cast<double>(k % 1013);
    stamps_s[k] = 0.01 * static_cast<double>(k) + (k > 30'000 ? 5.0 : 0.0);
  }
  const auto cut_by = [&](std::size_t length) {
    RunningOverview overview(1);
    for (std::size_t first = 0; first < x.size(); first += length) {
      const std::size_t count = std::min(length, x.size() - first);
      overview.add({.first = first,
                    .channels = {View<double>(x).subspan(first, count)},
                    .stamps_s = View<double>(stamps_s).subspan(first, count)});
    }
    return overview.finish(head_of(0.0));
  };
  const Recording whole = cut_by(x.size());
  for (const std::size_t length : {1, 7, 64, 4097}) {
    const Recording cut = cut_by(length);
    EXPECT_EQ(cut.channels[0].values, whole.channels[0].values) << length;
    EXPECT_EQ(cut.time.stamps_s, whole.time.stamps_s) << length;
  }
}

}  // namespace
}  // namespace proofmass::signal::running_overview_test
