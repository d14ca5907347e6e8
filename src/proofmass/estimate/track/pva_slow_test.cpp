#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/estimate/track.hpp"
#include "proofmass/estimate/track_test_support.hpp"

namespace proofmass::estimate::track_pva_slow_test {
namespace {

// Ten strokes; in each the sensors tilt with their common body, and each has its own noise and
// bias.
CarriageRecord two_sensors(std::uint64_t seed, double lean_mps2) {
  Carriage carriage;
  carriage.strokes_m = {0.4, -0.4, 0.4, -0.4, 0.4, -0.4, 0.4, -0.4, 0.4, -0.4};
  carriage.seed = seed;
  CarriageRecord made = record(carriage);
  std::mt19937_64 engine(seed + 1000);
  std::normal_distribution<double> normal;
  ParallelAccelerometer& other = made.sensor.beside.emplace_back();
  double lean = 0.0;
  for (std::size_t k = 0; k < made.accel_mps2.size(); ++k) {
    const bool moving = made.velocity_mps[k] != 0.0;
    if (!moving)
      lean = 0.0;
    else if (lean == 0.0)
      lean = lean_mps2 * normal(engine);
    made.sensor.accel_mps2[0][k] += lean;
    other.accel_mps2[0].push_back(0.3 + made.accel_mps2[k] + lean + 0.02 * normal(engine));
    other.accel_mps2[1].push_back(0.02 * normal(engine));
    other.accel_mps2[2].push_back(standard_gravity_mps2 + 0.02 * normal(engine));
  }
  return made;
}

struct Tally {
  double inside = 0.0, of = 0.0, squares = 0.0, stated = 0.0;
  void add(double error, double std, double factor) {
    inside += std::abs(error) <= factor * std ? 1.0 : 0.0;
    of += 1.0;
    squares += error * error;
    stated += std * std;
  }
  [[nodiscard]] double share() const { return inside / of; }
  [[nodiscard]] double rms() const { return std::sqrt(squares / of); }
};

struct Tallies {
  Tally end, on_the_way;
  std::array<Tally, 2> alone;
  double nis = 0.0;
};

Tallies run(TrackModel model, double lean_mps2, std::size_t runs) {
  Tallies found;
  TrackOptions options;
  options.model = model;
  options.scale_std = 0.0;
  options.axis = {{1.0, 0.0, 0.0}};
  for (std::size_t seed = 1; seed <= runs; ++seed) {
    CarriageRecord made = two_sensors(seed, lean_mps2);
    if (model != TrackModel::fused) made.sensor.beside.clear();
    const auto track = estimate_track(made.sensor, options);
    EXPECT_TRUE(track);
    if (!track) continue;
    const auto& series = track->series;
    const std::size_t n = series.time_s.size();
    const double truth = made.position_m.back();
    found.end.add(series.position_m.back() - truth, series.position_std_m.back(), track->factor_95);
    for (std::size_t i = 3; i < 10; ++i)
      found.on_the_way.add(series.position_m[i * n / 10] - made.position_m[i * n / 10],
                           series.position_std_m[i * n / 10], track->factor_95);
    found.nis += track->consistency.nis / static_cast<double>(runs);
    if (!track->fused) continue;
    for (std::size_t s = 0; s < 2; ++s) {
      const Uncertain& end = track->fused->sensors[s].displacement_m;
      found.alone[s].add(end.value - truth, end.std, track->factor_95);
    }
  }
  return found;
}

TEST(TrackPvaCoverage, NinetyFivePercentBandsHoldTheTruthInNinetyThreeToNinetySeven) {
  const Tallies found = run(TrackModel::pva, 0.0, 500);
  EXPECT_GT(found.end.share(), 0.93);
  EXPECT_LT(found.end.share(), 0.975);
  EXPECT_GT(found.on_the_way.share(), 0.93);
  EXPECT_LT(found.on_the_way.share(), 0.98);
  RecordProperty("end", std::to_string(found.end.share()));
  RecordProperty("on_the_way", std::to_string(found.on_the_way.share()));
}

TEST(TrackFusedCoverage, TwoSensorsAreNearerTheTruthThanEachAloneAndSayHowNear) {
  const Tallies found = run(TrackModel::fused, 0.0, 300);
  EXPECT_GT(found.end.share(), 0.93);
  EXPECT_LT(found.end.share(), 0.985);
  EXPECT_LT(found.end.rms(), 0.8 * found.alone[0].rms());
  EXPECT_LT(found.end.rms(), 0.8 * found.alone[1].rms());
  RecordProperty("end", std::to_string(found.end.share()));
  RecordProperty("on_the_way", std::to_string(found.on_the_way.share()));
  RecordProperty("rms_fused", std::to_string(found.end.rms()));
  RecordProperty("rms_first", std::to_string(found.alone[0].rms()));
  RecordProperty("rms_second", std::to_string(found.alone[1].rms()));
}

TEST(TrackFusedCoverage, WhatLeansBothSensorsIsInTheBand) {
  const Tallies found = run(TrackModel::fused, 0.02, 100);
  EXPECT_GT(found.end.share(), 0.93);
  EXPECT_GT(found.on_the_way.share(), 0.93);
}

}  // namespace
}  // namespace proofmass::estimate::track_pva_slow_test
