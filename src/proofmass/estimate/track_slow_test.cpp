#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/track.hpp"
#include "proofmass/estimate/track_test_support.hpp"

namespace proofmass::estimate::track_slow_test {
namespace {

struct Coverage {
  double inside = 0.0, of = 0.0;
  void add(double error, double half_width) {
    inside += std::abs(error) <= half_width ? 1.0 : 0.0;
    of += 1.0;
  }
  [[nodiscard]] double share() const { return inside / of; }
};

struct Coverages {
  Coverage end, on_the_way, strokes;
};

// Coverage by the bands of many records of the same carriage with independent noise.
Coverages cover(Carriage carriage, std::size_t runs) {
  Coverages found;
  TrackOptions options;
  options.scale_std = 0.0;
  options.axis = carriage.direction;
  for (carriage.seed = 1; carriage.seed <= runs; ++carriage.seed) {
    const CarriageRecord made = record(carriage);
    const auto track = estimate_track(made.sensor, options);
    if (!track) continue;
    const TrackSeries& series = track->series;
    const auto at = [&](std::size_t k, Coverage& into) {
      into.add(series.position_m[k] - made.position_m[k],
               track->factor_95 * series.position_std_m[k]);
    };
    const std::size_t n = series.time_s.size();
    at(n - 1, found.end);
    for (std::size_t i = 3; i < 10; ++i) at(i * n / 10, found.on_the_way);
    for (const Stroke& stroke : track->strokes) {
      const double truth = made.position_m[stroke.turn] - made.position_m[stroke.first];
      found.strokes.add(stroke.out_m.value - truth, track->factor_95 * stroke.out_m.std);
    }
  }
  return found;
}

TEST(TrackCoverage, NinetyFivePercentBandsFromRestToRestHoldTheTruthInNinetyThreeToNinetySeven) {
  const Coverages found =
      cover({.strokes_m = {0.4, -0.4, 0.4, -0.4, 0.4, -0.4, 0.4, -0.4, 0.4, -0.4}}, 600);
  EXPECT_EQ(found.end.of, 600.0);
  EXPECT_GT(found.end.share(), 0.93);
  EXPECT_LT(found.end.share(), 0.975);
  EXPECT_GT(found.on_the_way.share(), 0.93);
  EXPECT_LT(found.on_the_way.share(), 0.98);
  EXPECT_EQ(found.strokes.of, 6000.0);
  EXPECT_GT(found.strokes.share(), 0.93);
  EXPECT_LT(found.strokes.share(), 0.98);
  RecordProperty("end", std::to_string(found.end.share()));
  RecordProperty("on_the_way", std::to_string(found.on_the_way.share()));
  RecordProperty("strokes", std::to_string(found.strokes.share()));
}

// One closure hardly determines the errors in motion: the bands are wider than necessary.
TEST(TrackCoverage, OneMotionAloneIsNeverTooSure) {
  const Coverages found = cover(
      {.strokes_m = {0.5, -0.5, 0.5, -0.5, 0.5, -0.5, 0.5, -0.5}, .dwell_s = 4.0, .harmonic = true},
      400);
  EXPECT_GT(found.end.of, 390.0);
  EXPECT_GT(found.end.share(), 0.93);
  EXPECT_GT(found.on_the_way.share(), 0.93);
  EXPECT_GT(found.strokes.share(), 0.93);
}

}  // namespace
}  // namespace proofmass::estimate::track_slow_test
