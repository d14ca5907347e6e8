#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/estimate/filter/allocation_counter.hpp"
#include "proofmass/estimate/live_track_test_support.hpp"
#include "proofmass/estimate/track/live_scale.hpp"

namespace proofmass::estimate::live_track_test {
namespace {

Carriage carriage() {
  return {.dwell_s = 3.5};
}

LiveTrackOptions along_x() {
  LiveTrackOptions options = live_options();
  options.axis = {1.0, 0.0, 0.0};
  return options;
}

std::size_t sample_at(const TrackSensor& sensor, double time_s) {
  const auto found = std::ranges::lower_bound(sensor.time_s, time_s);
  return static_cast<std::size_t>(found - sensor.time_s.begin());
}

void expect_same(const std::vector<double>& one, const std::vector<double>& other) {
  ASSERT_EQ(one.size(), other.size());
  EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0);
}

TEST(LiveTrack, PiecesOfAnySizeGiveTheSameRows) {
  const CarriageRecord made = record(carriage());
  const LiveTrackRun whole = run_live(made.sensor, live_options(), made.sensor.time_s.size());
  ASSERT_GT(whole.rows.rows(), 1000u);
  for (const std::size_t piece : {1u, 7u, 333u}) {
    const LiveTrackRun run = run_live(made.sensor, live_options(), piece);
    expect_same(run.rows.stamps_s, whole.rows.stamps_s);
    for (std::size_t c = 0; c < whole.rows.channels.size(); ++c)
      expect_same(run.rows.channels[c], whole.rows.channels[c]);
  }
}

TEST(LiveTrack, FollowsStrokesAndDetectsTheirStops) {
  const CarriageRecord made = record(carriage());
  const LiveTrackRun run = run_live(made.sensor, along_x());
  ASSERT_GT(run.rows.rows(), 1000u);
  EXPECT_TRUE(run.notes.empty()) << run.notes.front().text;
  std::size_t stops = 0;
  for (std::size_t k = 1; k < run.rows.rows(); ++k) {
    const auto at = [&](LiveTrackColumn column) { return run.rows.channels[column][k]; };
    const std::size_t sample = sample_at(made.sensor, run.rows.stamps_s[k] - 1e-6);
    EXPECT_LE(std::abs(at(live_position) - made.position_m[sample]), 4.0 * at(live_position_std));
    EXPECT_LT(std::abs(at(live_velocity) - made.velocity_mps[sample]), 4.0 * at(live_velocity_std));
    if (at(live_resting) != 1.0) continue;
    EXPECT_EQ(made.velocity_mps[sample], 0.0);
    stops += run.rows.channels[live_resting][k - 1] == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(stops, 4u);
  EXPECT_LT(run.last(live_position_std), 0.02);
}

TEST(LiveTrack, AgreesWithTheWholeRecordingsTrack) {
  CarriageRecord made = record({.strokes_m = {0.4, 0.3, -0.2}, .dwell_s = 3.5});
  const LiveTrackRun run = run_live(made.sensor, along_x());
  TrackOptions options;
  options.axis = {1.0, 0.0, 0.0};
  options.scale_std = 0.0;
  const auto track = estimate_track(made.sensor, options);
  ASSERT_TRUE(track && track->smoother);
  const Uncertain whole = track->smoother->displacement_m;
  const double live = run.last(live_position), std = run.last(live_position_std);
  EXPECT_LT(std::abs(live - whole.value), 2.0 * std::hypot(std, whole.std));
  EXPECT_LT(std::abs(live - 0.5), 2.0 * std);
}

TEST(LiveTrack, FindsTheAxisOfTheFirstMotionAndGivesItsRowsThen) {
  Carriage oblique = carriage();
  oblique.direction = {0.6, 0.0, -0.8};
  const CarriageRecord made = record(oblique);
  LiveTrackOptions options = live_options();
  const LiveTrackRun found = run_live(made.sensor, options);
  options.axis = {-0.6, 0.0, 0.8};
  const LiveTrackRun given = run_live(made.sensor, options);
  expect_same(found.rows.stamps_s, given.rows.stamps_s);
  for (std::size_t k = 0; k < given.rows.rows(); ++k)
    EXPECT_NEAR(found.rows.channels[live_position][k], given.rows.channels[live_position][k], 2e-3);
}

TEST(LiveTrack, AStopPullsInTheSmoothedPositionsBeforeIt) {
  const CarriageRecord made = record(carriage());
  const LiveTrackRun run = run_live(made.sensor, along_x());
  double filtered_std = 0.0, smoothed_std = 0.0;
  std::size_t smoothed = 0;
  const auto& columns = run.rows.channels;
  for (std::size_t k = 0; k < run.rows.rows(); ++k) {
    const double time_s = columns[live_smoothed_time][k];
    if (std::isnan(time_s)) continue;
    const auto then = std::ranges::lower_bound(run.rows.stamps_s, time_s - 1e-6);
    const auto row = static_cast<std::size_t>(then - run.rows.stamps_s.begin());
    ASSERT_NEAR(run.rows.stamps_s[row], time_s, 1e-6);
    EXPECT_NEAR(run.rows.stamps_s[k] - time_s, 3.0, 0.05);
    const double off =
        columns[live_smoothed_position][k] - made.position_m[sample_at(made.sensor, time_s - 1e-6)];
    EXPECT_LE(std::abs(off), 4.0 * columns[live_smoothed_position_std][k]);
    ++smoothed;
    if (columns[live_resting][row] == 1.0) continue;
    filtered_std += columns[live_position_std][row];
    smoothed_std += columns[live_smoothed_position_std][k];
  }
  EXPECT_GT(smoothed, 1000u);
  EXPECT_LT(smoothed_std, 0.8 * filtered_std);
}

TEST(LiveTrack, AsksForARestWhereThereIsNone) {
  TrackSensor sensor;
  sensor.name = "acc";
  for (std::size_t k = 0; k < 1500; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    sensor.time_s.push_back(t);
    sensor.accel_mps2[0].push_back(3.0 * std::sin(5.0 * t) + std::sin(17.0 * t));
    sensor.accel_mps2[1].push_back(2.0 * std::sin(7.0 * t));
    sensor.accel_mps2[2].push_back(9.8 + std::sin(3.0 * t));
  }
  const LiveTrackRun run = run_live(sensor, live_options());
  EXPECT_EQ(run.rows.rows(), 0u);
  EXPECT_TRUE(run.says("keep it still"));
}

TEST(LiveTrack, AFirstRestThatIsTooShortIsSaidWithWhatIsLeftOut) {
  CarriageRecord made = record(carriage());  // rests of 3.5 s
  const std::size_t cut = sample_at(made.sensor, 1.5);
  made.sensor.time_s.erase(made.sensor.time_s.begin(),
                           made.sensor.time_s.begin() + static_cast<std::ptrdiff_t>(cut));
  for (auto& axis : made.sensor.accel_mps2)
    axis.erase(axis.begin(), axis.begin() + static_cast<std::ptrdiff_t>(cut));
  const LiveTrackRun run = run_live(made.sensor, along_x());
  EXPECT_TRUE(run.says("counts from 0 at the rest"));
  EXPECT_TRUE(run.says("is left out"));
  EXPECT_GT(run.rows.stamps_s.front(), 4.9);  // the end of the first stroke
}

TEST(LiveTrack, AGapInTheMotionIsSaidAndWidensTheBand) {
  CarriageRecord made = record(carriage());
  const LiveTrackRun whole = run_live(made.sensor, along_x());
  const std::size_t first = sample_at(made.sensor, 3.9), last = sample_at(made.sensor, 4.2);
  const auto cut = [&](std::vector<double>& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(first),
                 values.begin() + static_cast<std::ptrdiff_t>(last));
  };
  cut(made.sensor.time_s);
  for (std::vector<double>& axis : made.sensor.accel_mps2) cut(axis);
  const LiveTrackRun run = run_live(made.sensor, along_x());
  EXPECT_TRUE(run.says("without a measurement"));
  EXPECT_GT(run.last(live_position_std), 2.0 * whole.last(live_position_std));
  EXPECT_LT(std::abs(run.last(live_position)), 2.0 * run.last(live_position_std));
  EXPECT_LT(run.last(live_velocity_std), 0.01);
}

TEST(LiveTrack, ASensorThatTurnedIsSaidAndLessSureFromThereOn) {
  CarriageRecord made = record(carriage());
  const LiveTrackRun straight = run_live(made.sensor, along_x());
  const std::size_t moved = sample_at(made.sensor, 9.2);
  const double leaned_mps2 = standard_gravity_mps2 * std::sin(1.5 * rad_per_deg);
  for (std::size_t k = moved; k < made.sensor.time_s.size(); ++k)
    made.sensor.accel_mps2[0][k] += leaned_mps2;
  const LiveTrackRun run = run_live(made.sensor, along_x());
  EXPECT_TRUE(run.says("the sensor turned"));
  EXPECT_GT(run.last(live_position_std), 2.0 * straight.last(live_position_std));
  EXPECT_LT(std::abs(run.last(live_position)), 2.0 * run.last(live_position_std));
}

TEST(LiveTrack, ConstantSpeedIsNotAStop) {
  CarriageRecord made = record({.strokes_m = {0.4}, .dwell_s = 4.0});
  TrackSensor& sensor = made.sensor;
  // The stroke's acceleration, then nothing for 4 s, then its deceleration: 0.75 s each.
  const std::size_t turn = sample_at(sensor, 4.75), count = sensor.time_s.size();
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double>& axis = sensor.accel_mps2[i];
    const std::vector<double> quiet(axis.begin(), axis.begin() + 390);
    axis.insert(axis.begin() + static_cast<std::ptrdiff_t>(turn), quiet.begin(), quiet.end());
  }
  for (std::size_t k = 0; k < 390; ++k)
    sensor.time_s.push_back(static_cast<double>(count + k) / 100.0);
  const LiveTrackRun run = run_live(sensor, along_x());
  EXPECT_TRUE(run.says("constant speed"));
  const double top_speed_mps = 0.4 / 1.5 * 1.875;
  EXPECT_NEAR(run.last(live_position), 0.4 + 3.9 * top_speed_mps,
              2.0 * run.last(live_position_std));
  EXPECT_LT(run.last(live_position_std), 0.2);
}

// Noise that grows with the motion must not make the motion look like noise.
TEST(LiveTrack, AnOscillationWithRockingIsNotARest) {
  CarriageRecord made =
      record({.strokes_m = {0.5, -0.5, 0.5, -0.5, 0.5, -0.5}, .dwell_s = 4.0, .harmonic = true});
  std::mt19937_64 engine(201);
  std::normal_distribution<double> rocking(0.0, 0.1);
  for (std::size_t k = 0; k < made.velocity_mps.size(); ++k)
    if (made.velocity_mps[k] != 0.0) made.sensor.accel_mps2[0][k] += rocking(engine);
  const LiveTrackRun run = run_live(made.sensor, along_x());
  ASSERT_GT(run.rows.rows(), 1000u);
  for (std::size_t k = 0; k < run.rows.rows(); ++k) {
    const bool moves = run.rows.stamps_s[k] > 4.0 && run.rows.stamps_s[k] < 13.0;
    EXPECT_FALSE(moves && run.rows.channels[live_resting][k] == 1.0);
  }
  EXPECT_LT(std::abs(run.last(live_position)), 2.0 * run.last(live_position_std));
}

TEST(LiveTrack, WithoutReadingsOrWithAClockSetBackItGoesOn) {
  CarriageRecord made = record(carriage());
  for (std::size_t k = sample_at(made.sensor, 9.0); k < sample_at(made.sensor, 9.1); ++k)
    made.sensor.accel_mps2[0][k] = std::nan("");
  const std::size_t back = sample_at(made.sensor, 11.0);
  for (std::size_t k = back; k < made.sensor.time_s.size(); ++k) made.sensor.time_s[k] -= 10.0;
  const LiveTrackRun run = run_live(made.sensor, along_x());
  EXPECT_TRUE(run.says("measurements excluded"));
  EXPECT_TRUE(run.says("the clock stepped back"));
  EXPECT_EQ(run.last(live_resting), 0.0);
  EXPECT_LT(run.last(live_velocity_std), 0.05);
  for (const double value : run.rows.channels[live_position]) EXPECT_TRUE(std::isfinite(value));
}

TEST(LiveTrack, NothingIsAllocatedForASampleBetweenBlocks) {
  Carriage fast = carriage();
  fast.rate_hz = 200.0;
  const CarriageRecord made = record(fast);
  auto live = live_track(along_x());
  ASSERT_TRUE(live);
  Rows out;
  const std::size_t warm = sample_at(made.sensor, 8.0), size = made.sensor.time_s.size();
  ASSERT_TRUE((*live)->add(block_of(made.sensor, 0, warm), out));
  std::vector<Block> blocks;
  for (std::size_t k = warm; k < size; ++k) blocks.push_back(block_of(made.sensor, k, 1));
  out.stamps_s.reserve(size);
  for (auto& column : out.channels) column.reserve(size);
  std::size_t allocating = 0;
  for (const Block& one : blocks) {
    const std::size_t before = test::allocations();
    ASSERT_TRUE((*live)->add(one, out));
    allocating += test::allocations() > before ? 1 : 0;
  }
  constexpr double block_samples = 12.0;  // an eighth of half a second
  EXPECT_LE(static_cast<double>(allocating),
            static_cast<double>(size - warm) / block_samples + 2.0);
}

TEST(LiveTrack, RefusesWhatGivesNoDisplacement) {
  const auto error = [](const LiveTrackOptions& options) {
    const auto made = live_track(options);
    return made ? Errc{} : made.error().code;
  };
  LiveTrackOptions options = live_options();
  options.axis = {0.0, 0.0, 0.0};
  EXPECT_EQ(error(options), Errc::invalid_argument);
  options = live_options();
  options.sensor.z.reset();
  options.axis = {1.0, 0.0, 1.0};
  EXPECT_EQ(error(options), Errc::invalid_argument);
  options = live_options();
  options.sensor = {"acc", {}, {}, {}};
  EXPECT_EQ(error(options), Errc::invalid_argument);
  options = live_options();
  options.lag_s = std::nan("");
  EXPECT_EQ(error(options), Errc::invalid_argument);
}

TEST(LiveTrack, OneAxisIsEnough) {
  const CarriageRecord made = record(carriage());
  LiveTrackOptions options = live_options();
  options.sensor = {"acc", 0, {}, {}};
  const LiveTrackRun run = run_live(made.sensor, options);
  ASSERT_GT(run.rows.rows(), 1000u);
  EXPECT_LT(std::abs(run.last(live_position)), 2.0 * run.last(live_position_std));
  EXPECT_LT(run.last(live_position_std), 0.02);
}

// Closures explained by noise leave little scale uncertainty; large ones as much as they imply.
TEST(MotionScale, FollowsTheClosures) {
  MotionScale calm, rough;
  EXPECT_GT(calm.scale(), 10.0);
  EXPECT_NEAR(calm.middle(), 1.0, 0.3);
  const double known = 1e-5, usual = usual_velocity_variance(2.0);
  for (int k = 0; k < 20; ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    calm.learn(sign * std::sqrt(known), known, usual);
    rough.learn(sign * std::sqrt(known + 100.0 * usual), known, usual);
  }
  EXPECT_LT(calm.scale() * usual, known);
  EXPECT_GT(rough.scale(), 90.0);
  EXPECT_LT(rough.scale(), 250.0);
}

}  // namespace
}  // namespace proofmass::estimate::live_track_test
