#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/estimate/live_track_test_support.hpp"

namespace proofmass::estimate::live_track_slow_test {
namespace {

struct Share {
  double inside = 0.0, of = 0.0;
  void add(double error, double std) {
    inside += std::abs(error) <= 1.96 * std ? 1.0 : 0.0;
    of += 1.0;
  }
  [[nodiscard]] double share() const { return inside / of; }
};

struct Shares {
  Share end, stops, on_the_way, smoothed;
};

/// `lean` in m/s²/√Hz: rocking of the sensor in motion, which rests do not show.
Shares cover(Carriage carriage, double lean, std::size_t runs) {
  Shares found;
  LiveTrackOptions options = live_options();
  options.axis = carriage.direction;
  for (carriage.seed = 1; carriage.seed <= runs; ++carriage.seed) {
    CarriageRecord made = record(carriage);
    std::mt19937_64 engine(carriage.seed + runs);
    std::normal_distribution<double> rocking(0.0, lean * std::sqrt(carriage.rate_hz));
    for (std::size_t k = 0; lean > 0.0 && k < made.accel_mps2.size(); ++k)
      if (made.velocity_mps[k] != 0.0) made.sensor.accel_mps2[0][k] += rocking(engine);
    const LiveTrackRun run = run_live(made.sensor, options);
    const auto truth = [&](double time_s) {
      return made.position_m[static_cast<std::size_t>(std::lround(time_s * carriage.rate_hz))];
    };
    const auto& columns = run.rows.channels;
    for (std::size_t k = 1; k < run.rows.rows(); ++k) {
      const double error = columns[live_position][k] - truth(run.rows.stamps_s[k]);
      const bool resting = columns[live_resting][k] == 1.0;
      if (resting && columns[live_resting][k - 1] == 0.0)
        found.stops.add(error, columns[live_position_std][k]);
      if (!resting && k % 10 == 0) found.on_the_way.add(error, columns[live_position_std][k]);
      if (k + 1 == run.rows.rows()) found.end.add(error, columns[live_position_std][k]);
      const double then_s = columns[live_smoothed_time][k];
      if (k % 10 == 0 && !std::isnan(then_s) && columns[live_smoothed_position_std][k] > 0.0)
        found.smoothed.add(columns[live_smoothed_position][k] - truth(then_s),
                           columns[live_smoothed_position_std][k]);
    }
  }
  return found;
}

void expect_cautious(const Shares& found) {
  EXPECT_GT(found.end.share(), 0.93);
  EXPECT_GT(found.stops.share(), 0.93);
  EXPECT_GT(found.on_the_way.share(), 0.93);
  EXPECT_GT(found.smoothed.share(), 0.93);
}

const std::vector<double> eight_strokes{0.4, -0.4, 0.4, -0.4, 0.4, -0.4, 0.4, -0.4};

TEST(LiveTrackCoverage, BandsCoverTheTruthUnderNoiseOnly) {
  const Shares found = cover({.strokes_m = eight_strokes, .dwell_s = 3.5}, 0.0, 200);
  EXPECT_EQ(found.end.of, 200.0);
  EXPECT_EQ(found.stops.of, 1600.0);
  expect_cautious(found);
}

TEST(LiveTrackCoverage, BandsHoldTheTruthWhereTheSensorRocks) {
  const Shares found = cover({.strokes_m = eight_strokes, .dwell_s = 3.5}, 0.02, 200);
  EXPECT_EQ(found.end.of, 200.0);
  expect_cautious(found);
}

TEST(LiveTrackCoverage, OneMotionAloneIsNeverTooSure) {
  const Shares found =
      cover({.strokes_m = {0.5, -0.5, 0.5, -0.5, 0.5, -0.5}, .dwell_s = 4.0, .harmonic = true},
            0.01, 200);
  EXPECT_EQ(found.end.of, 200.0);
  expect_cautious(found);
}

}  // namespace
}  // namespace proofmass::estimate::live_track_slow_test
