#include "proofmass/signal/skew.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace proofmass::signal::skew_test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Skew, IsTakenOutOfAScannedSine) {
  const double rate_hz = 1000.0;
  const double between_s = 0.12e-3;
  for (const double frequency_hz : {13.0, 200.0, 400.0}) {
    Recording scanned;
    scanned.time.source = TimeSource::given_rate;
    scanned.time.rate_hz = rate_hz;
    for (std::size_t c = 0; c < 6; ++c) {
      scanned.channels.push_back({"c" + std::to_string(c), {}, {}});
      for (std::size_t k = 0; k < 2000; ++k) {
        const double t = static_cast<double>(k) / rate_hz + static_cast<double>(c) * between_s;
        scanned.channels[c].values.edit().push_back(std::sin(2.0 * pi * frequency_hz * t));
      }
    }
    const auto even = without_skew(scanned, between_s);
    ASSERT_TRUE(even.has_value());
    for (std::size_t c = 0; c < 6; ++c)
      for (std::size_t k = 100; k < 1900; ++k)
        ASSERT_NEAR(even->channels[c].values[k], scanned.channels[0].values[k], 1e-4)
            << frequency_hz << " Hz, channel " << c;
    EXPECT_TRUE(even->notes.back().text.starts_with("channels moved to the time of the first"));
  }
}

TEST(Skew, OfAConstantIsNothingUpToTheEnds) {
  const std::vector<double> constant(100, 9.81);
  for (const double x : delayed(constant, 0.37)) EXPECT_NEAR(x, 9.81, 1e-12);
}

TEST(Skew, OfAWholeSampleIsTheSampleBefore) {
  std::vector<double> series;
  for (int k = 0; k < 100; ++k) series.push_back(k * k % 17);
  const auto moved = delayed(series, 1.0);
  for (std::size_t k = 1; k < 100; ++k) EXPECT_NEAR(moved[k], series[k - 1], 1e-9);
}

TEST(Skew, StaysEmptyWhereAValueIsMissing) {
  std::vector<double> series(100, 1.0);
  series[50] = std::nan("");
  const auto moved = delayed(series, 0.25);
  for (std::size_t k = 0; k < 100; ++k) EXPECT_EQ(std::isnan(moved[k]), k == 50 || k == 51) << k;
}

TEST(Skew, OfMoreThanAStepIsRefused) {
  Recording recording;
  recording.time.rate_hz = 100.0;
  recording.channels.assign(5, {"x", {}, {1.0, 2.0}});
  EXPECT_EQ(without_skew(recording, 0.003).error().code, Errc::invalid_argument);
  recording.time.rate_hz = 0.0;
  EXPECT_EQ(without_skew(recording, 0.001).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::signal::skew_test
