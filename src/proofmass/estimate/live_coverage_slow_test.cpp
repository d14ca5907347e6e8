#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/live_test_support.hpp"
#include "proofmass/estimate/live_tilt.hpp"
#include "proofmass/estimate/live_wheel.hpp"
#include "proofmass/estimate/tilt_test_support.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

// Coverage of the 95 % bands of the live angle and inclination.
namespace proofmass::estimate::live_coverage_slow_test {
namespace {

struct Coverage {
  double inside = 0.0, all = 0.0;
  void add(double off, double std) {
    inside += std::abs(off) <= 1.959964 * std ? 1.0 : 0.0;
    all += 1.0;
  }
  [[nodiscard]] double share() const { return inside / all; }
};

struct LiveCoverage {
  Coverage filtered, lagged;
};

/// Two opposite sensors with biases and a warm-up, from five seconds on.
void run_wheel(const test::Drive& drive, std::uint64_t seed, LiveCoverage& coverage) {
  test::Normal draw(seed);
  test::Stream stream;
  LiveWheelOptions options;
  options.wheel.radius_m = 0.1;
  for (std::size_t s = 0; s < 2; ++s) {
    test::Mount mount;
    mount.place_m = s == 0 ? 0.1 : -0.1;
    mount.bias_mps2 = {0.6 * (draw.uniform() - 0.5), 0.6 * (draw.uniform() - 0.5)};
    mount.noise_mps2 = 0.0184;
    mount.warm_up_mps2 = 0.1;
    const WheelSensor sensor = test::record(drive, mount, 200.0, 1000 * seed + s);
    stream.stamps_s = sensor.time_s;
    for (const auto& axis : sensor.accel_mps2) stream.channels.push_back(axis);
    options.sensors.push_back({"acc", 3 * s, 3 * s + 1, 3 * s + 2});
  }
  auto live = live_wheel(options).value();
  const test::Fed fed = test::feed(*live, stream, 20);
  const auto& column = fed.rows.channels;
  const auto off = [&](double angle, double time_s) {
    return std::remainder(angle - drive.at(time_s).angle_rad, rad_per_turn);
  };
  for (std::size_t k = 0; k < fed.rows.rows(); k += 5) {
    if (fed.rows.stamps_s[k] < 5.0) continue;
    coverage.filtered.add(off(column[0][k], fed.rows.stamps_s[k]), column[1][k]);
    coverage.lagged.add(off(column[5][k], column[4][k]), column[6][k]);
  }
}

TEST(LiveWheelCoverage, AtOneSpeedIsNinetyFivePercentOrMore) {
  LiveCoverage coverage;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    test::Drive drive{{0.3 * static_cast<double>(seed), 11 * test::rpm}, {{60.0, 11 * test::rpm}}};
    drive.ripple = 0.02;
    drive.ripple_phase_rad = 0.7 * static_cast<double>(seed);
    run_wheel(drive, seed, coverage);
  }
  RecordProperty("filtered", std::to_string(coverage.filtered.share()));
  RecordProperty("lagged", std::to_string(coverage.lagged.share()));
  EXPECT_GT(coverage.filtered.share(), 0.94);
  EXPECT_GT(coverage.lagged.share(), 0.94);
}

TEST(LiveWheelCoverage, WhereTheSpeedChangesIsNineTenthsOrMore) {
  LiveCoverage coverage;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    run_wheel({{0.3 * static_cast<double>(seed), 5.0}, {{15.0, 5.0}, {4.0, 10.0}, {16.0, 10.0}}},
              100 + seed, coverage);
  RecordProperty("filtered", std::to_string(coverage.filtered.share()));
  RecordProperty("lagged", std::to_string(coverage.lagged.share()));
  EXPECT_GT(coverage.filtered.share(), 0.90);
  EXPECT_GT(coverage.lagged.share(), 0.90);
}

TEST(LiveTiltCoverage, InMotionIsNinetyFivePercentOrMore) {
  for (const bool gyroscope : {true, false}) {
    LiveCoverage coverage;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const MovingBase base =
          moving_base({.samples = 3000, .accel_std_mps2 = 0.3, .gyroscope = gyroscope}, 300 + seed);
      test::Stream stream{base.record.time_s, {}};
      for (const auto& axis : base.record.accel_mps2) stream.channels.push_back(axis);
      for (const auto& axis : base.record.rate_radps)
        if (gyroscope) stream.channels.push_back(axis);
      LiveTiltOptions options;
      options.tilt.bias_std_mps2 = 0.0;
      options.accelerometer = {"acc", 0, 1, 2};
      if (gyroscope) options.gyroscope = Triad{"gyr", 3, 4, 5};
      auto live = live_tilt(options).value();
      const auto column = test::feed(*live, stream, 20).rows.channels;
      for (std::size_t k = 200; k < 3000; k += 20) {
        coverage.filtered.add(column[2][k] - base.pitch_rad[k], column[3][k]);
        const auto then = static_cast<std::size_t>(std::lround(100.0 * column[4][k]));
        coverage.lagged.add(column[7][k] - base.pitch_rad[then], column[8][k]);
      }
    }
    RecordProperty(gyroscope ? "with_gyroscope" : "without",
                   std::to_string(coverage.filtered.share()));
    EXPECT_GT(coverage.filtered.share(), 0.93) << gyroscope;
    EXPECT_GT(coverage.lagged.share(), 0.93) << gyroscope;
  }
}

}  // namespace
}  // namespace proofmass::estimate::live_coverage_slow_test
