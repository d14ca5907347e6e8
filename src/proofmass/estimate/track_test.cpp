#include "proofmass/estimate/track.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/track_test_support.hpp"

namespace proofmass::estimate::track_test {
namespace {

constexpr double g = standard_gravity_mps2;

TrackOptions exact_scale() {
  TrackOptions options;
  options.scale_std = 0.0;
  return options;
}

TrackSolution track(const CarriageRecord& record, const TrackOptions& options = exact_scale()) {
  auto solution = estimate_track(record.sensor, options);
  return std::move(solution).value();
}

bool says(const TrackSolution& solution, const char* words) {
  return std::any_of(solution.notes.begin(), solution.notes.end(),
                     [&](const Note& note) { return note.text.find(words) != std::string::npos; });
}

TEST(Track, MeasuresEveryStrokeFromRestToRest) {
  const TrackSolution found = track(record({.strokes_m = {0.4, -0.3, 0.5}}));
  ASSERT_EQ(found.rests.size(), 4U);
  ASSERT_EQ(found.strokes.size(), 3U);
  const double lengths[] = {0.4, -0.3, 0.5};
  for (std::size_t i = 0; i < 3; ++i) {
    const Stroke& stroke = found.strokes[i];
    EXPECT_NEAR(stroke.out_m.value, lengths[i], 4.0 * stroke.out_m.std);
    EXPECT_LT(stroke.out_m.std, 0.01);
    EXPECT_FALSE(stroke.back_m);
  }
  EXPECT_NEAR(found.smoother->displacement_m.value, 0.6, 4.0 * found.smoother->displacement_m.std);
  EXPECT_NEAR(found.smoother->path_m, 1.2, 0.02);
  EXPECT_NEAR(found.smoother->peak_m.value, 0.6, 0.02);
}

TEST(Track, WithoutNoiseIsExactToATenthOfAMillimetre) {
  const TrackSolution found = track(record({.rate_hz = 400.0, .noise_std_mps2 = 1e-6}));
  for (const Stroke& stroke : found.strokes) EXPECT_NEAR(std::abs(stroke.out_m.value), 0.4, 1e-4);
  EXPECT_NEAR(found.smoother->displacement_m.value, 0.0, 1e-4);
}

TEST(Track, ConstantReadingsAtRestAreAsUncertainAsTheirStep) {
  Carriage carriage{.noise_std_mps2 = 0.0};
  CarriageRecord made = record(carriage);
  for (auto& axis : made.sensor.accel_mps2)
    for (double& value : axis) value = 0.01 * std::round(value / 0.01);
  const TrackSolution found = track(made);
  EXPECT_TRUE(std::isfinite(found.smoother->displacement_m.std));
  EXPECT_NEAR(found.smoother->peak_m.value, 0.4, 4.0 * found.smoother->peak_m.std);
}

TEST(Track, FindsTheAxisOfTheMotionWhereverItPoints) {
  Carriage carriage;
  carriage.direction = {0.36, 0.48, -0.8};
  const TrackSolution found = track(record(carriage));
  double cosine = 0.0;
  for (std::size_t i = 0; i < 3; ++i) cosine += found.axis[i] * carriage.direction[i];
  EXPECT_LT(cosine, -0.9999);  // its largest component is positive
  EXPECT_GT(found.axis[2], 0.0);
  EXPECT_GT(found.travel_share, 0.99);
}

TEST(Track, NeedsNoGravityAndSaysWhichItFound) {
  Carriage carriage;
  const TrackSolution present = track(record(carriage));
  carriage.at_rest_mps2 = {0.01, -0.02, 0.015};
  const TrackSolution removed = track(record(carriage));
  EXPECT_EQ(present.gravity, GravityContent::present);
  EXPECT_EQ(removed.gravity, GravityContent::removed);
  EXPECT_NEAR(present.smoother->peak_m.value, removed.smoother->peak_m.value, 1e-9);
}

TEST(Track, CountsThereAndBackWithoutARestBetweenAsOneStroke) {
  Carriage carriage{
      .strokes_m = {0.5, -0.5, 0.5, -0.5, 0.5, -0.5}, .stroke_s = 1.0, .harmonic = true};
  const TrackSolution found = track(record(carriage));
  ASSERT_EQ(found.strokes.size(), 3U);
  for (const Stroke& stroke : found.strokes) {
    EXPECT_NEAR(stroke.length_m.value, 0.5, 4.0 * stroke.length_m.std);
    EXPECT_LT(stroke.length_m.std, 0.05);
    ASSERT_TRUE(stroke.back_m);
    EXPECT_LT(stroke.back_m->value, 0.0);
  }
}

// At the turning points of a harmonic motion the acceleration is constant for a moment.
TEST(Track, DoesNotTakeATurningPointAsARest) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Carriage carriage{.strokes_m = {0.5, -0.5, 0.5, -0.5},
                      .stroke_s = 2.5,
                      .dwell_s = 4.0,
                      .harmonic = true,
                      .seed = seed};
    const TrackSolution found = track(record(carriage));
    EXPECT_EQ(found.rests.size(), 2U) << seed;
    EXPECT_EQ(found.strokes.size(), 2U) << seed;
  }
}

TEST(Track, TheSamePlaceAtTheEndNarrowsTheBandOnTheWay) {
  const CarriageRecord made = record({.strokes_m = {0.5, -0.5}, .stroke_s = 6.0, .harmonic = true});
  TrackOptions options = exact_scale();
  options.still = {{0.0, 1.98}, {14.01, 15.98}};
  const TrackSolution open = track(made, options);
  options.same_place = true;
  const TrackSolution closed = track(made, options);
  EXPECT_NEAR(closed.smoother->displacement_m.value, 0.0, 4e-3);
  EXPECT_LE(closed.smoother->displacement_m.std, 1.1e-3);
  EXPECT_LT(closed.smoother->peak_m.std, 0.7 * open.smoother->peak_m.std);
}

TEST(Track, FusesFixesOfThePosition) {
  const CarriageRecord made = record({.strokes_m = {2.0}, .stroke_s = 20.0});
  TrackOptions options = exact_scale();
  options.axis = {{1.0, 0.0, 0.0}};
  options.still = {{0.0, 1.98}, {22.01, 23.98}};
  const TrackSolution alone = track(made, options);
  for (const double t : {7.0, 12.0, 17.0})
    options.fixes.push_back({t, made.position_m[static_cast<std::size_t>(t * 100.0)], 0.002});
  const TrackSolution fixed = track(made, options);
  const std::size_t at = 1200;
  EXPECT_NEAR(fixed.series.position_m[at], made.position_m[at], 0.008);
  EXPECT_LT(fixed.series.position_std_m[at], 0.0021);
  EXPECT_LT(fixed.smoother->displacement_m.std, 0.5 * alone.smoother->displacement_m.std);
}

TEST(Track, AGivenTurnIsAVelocityOfZero) {
  const CarriageRecord made = record({.strokes_m = {0.5, -0.5}, .stroke_s = 5.0, .harmonic = true});
  TrackOptions options = exact_scale();
  options.still = {{0.0, 1.98}, {12.01, 13.98}};
  const TrackSolution open = track(made, options);
  options.turns_s = {7.0};
  const TrackSolution given = track(made, options);
  EXPECT_LT(given.smoother->peak_m.std, open.smoother->peak_m.std);
  EXPECT_NEAR(given.smoother->peak_m.value, 0.5, 4.0 * given.smoother->peak_m.std);
}

TEST(Track, RefusesReadingsInGThatAreSaidToBeInMetres) {
  Carriage carriage;
  carriage.at_rest_mps2 = {0.0, 0.0, 1.0};
  const auto found = estimate_track(record(carriage).sensor, {});
  ASSERT_FALSE(found);
  ASSERT_FALSE(found.error().advice.empty());
  EXPECT_EQ(found.error().advice.front().value, "g");
  carriage.at_rest_mps2 = {0.0, 0.0, g * g};
  const auto other = estimate_track(record(carriage).sensor, {});
  ASSERT_FALSE(other);
  ASSERT_FALSE(other.error().advice.empty());
  EXPECT_EQ(other.error().advice.front().value, "m/s2");
}

TEST(Track, RefusesARecordWithoutARestAndSaysWhatToRecord) {
  CarriageRecord made = record({.strokes_m = {0.4, -0.4, 0.4, -0.4}, .harmonic = true});
  const std::size_t skip = 250;  // the rests at both ends
  made.sensor.time_s.erase(made.sensor.time_s.begin(), made.sensor.time_s.begin() + skip);
  made.sensor.time_s.resize(300);
  for (auto& axis : made.sensor.accel_mps2) {
    axis.erase(axis.begin(), axis.begin() + skip);
    axis.resize(300);
  }
  const auto found = estimate_track(made.sensor, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::not_observable);
  EXPECT_NE(found.error().message.find("still for 2 s"), std::string::npos);
}

TEST(Track, ReportsThatSlowMotionIsNotSeparableFromDrift) {
  const CarriageRecord made = record({.strokes_m = {2.0}, .stroke_s = 20.0});
  const auto found = estimate_track(made.sensor, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::not_observable);
  ASSERT_FALSE(found.error().advice.empty());
  EXPECT_EQ(found.error().advice.front().option, "still");
}

TEST(Track, ASensorThatNeverMovesWentNowhere) {
  const TrackSolution found = track(record({.strokes_m = {}, .dwell_s = 30.0}));
  const Uncertain& displacement = found.smoother->displacement_m;
  EXPECT_LT(std::abs(displacement.value), 2.0 * displacement.std);
  EXPECT_LT(displacement.std, 1.0);
  EXPECT_TRUE(found.strokes.empty());
  EXPECT_TRUE(found.no_motion_shown);
  EXPECT_TRUE(says(found, "no motion exceeds the noise"));
}

TEST(Track, TheBandHoldsTheTruthAcrossMissingReadings) {
  CarriageRecord made = record({});
  for (std::size_t k = 250; k < 262; ++k)
    made.sensor.accel_mps2[1][k] = std::numeric_limits<double>::quiet_NaN();
  made.sensor.accel_mps2[0][700] = 3e34;
  const TrackSolution found = track(made);
  EXPECT_EQ(found.missing, 13U);
  EXPECT_TRUE(says(found, "13 samples are missing"));
  for (std::size_t k = 0; k < made.position_m.size(); ++k)
    EXPECT_NEAR(found.series.position_m[k], made.position_m[k],
                5.0 * found.series.position_std_m[k] + 1e-9);
}

// As of a clock that is set forward. A constant unknown acceleration would be determined by the
// stops, and the displacement with it (132 km off at ± 3 km).
TEST(Track, AcrossAnHourWithoutMeasurementsThereIsNoDisplacement) {
  CarriageRecord made = record({});
  for (std::size_t k = 250; k < made.sensor.time_s.size(); ++k) made.sensor.time_s[k] += 3600.0;
  const auto none = estimate_track(made.sensor, {});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("may be any"), std::string::npos);
}

// A lift: it accelerates, moves at constant speed with vibration, and brakes. `derivative`: jerk
// instead of acceleration.
CarriageRecord lift(bool derivative, std::uint64_t seed = 3) {
  CarriageRecord made;
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto accel = [](double t) {
    const auto push = [&](double begin, double sign) {
      const double s = (t - begin) / 3.0;
      return s > 0.0 && s < 1.0
                 ? sign * 0.8 * std::sin(std::numbers::pi * s) * std::sin(std::numbers::pi * s)
                 : 0.0;
    };
    return push(10.0, 1.0) + push(30.0, -1.0) + push(45.0, -1.0) + push(65.0, 1.0);
  };
  double p = 0.0, v = 0.0;
  for (std::size_t k = 0; k < 2000; ++k) {
    const double t = static_cast<double>(k) * 0.04;
    const bool under_way = (t > 10.0 && t < 33.0) || (t > 45.0 && t < 68.0);
    const double clean = derivative ? (accel(t + 1e-4) - accel(t - 1e-4)) / 2e-4 : accel(t);
    made.sensor.time_s.push_back(t);
    made.sensor.accel_mps2[0].push_back(clean + (under_way ? 0.04 : 0.005) * noise(engine));
    made.position_m.push_back(p);
    p += 0.04 * v + 0.0008 * accel(t);
    v += 0.04 * accel(t + 0.02);
  }
  return made;
}

TEST(Track, NoticesAColumnThatIsJerkAndGivesNoFigure) {
  const TrackSolution found = track(lift(true));
  EXPECT_TRUE(found.suspected_jerk);
  EXPECT_FALSE(found.smoother);
  EXPECT_FALSE(found.double_integration);
  EXPECT_TRUE(found.strokes.empty());
  EXPECT_TRUE(says(found, "jerk"));
  TrackOptions options = exact_scale();
  options.take_as_acceleration = true;
  EXPECT_TRUE(track(lift(true), options).smoother);
}

// The position drift due to a level error between two rests is not evidence for either.
TEST(Track, DistinguishesJerkFromAccelerationAtAnyNoise) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    EXPECT_TRUE(track(lift(true, seed)).suspected_jerk) << seed;
    EXPECT_FALSE(track(lift(false, seed)).suspected_jerk) << seed;
  }
}

TEST(Track, TakesNoCruiseForARest) {
  const CarriageRecord made = lift(false);
  const TrackSolution found = track(made);
  ASSERT_FALSE(found.suspected_jerk);
  EXPECT_EQ(found.rests.size(), 3U);
  EXPECT_NEAR(found.smoother->peak_m.value, 24.0, 3.0 * found.smoother->peak_m.std);
  EXPECT_LT(found.smoother->peak_m.std, 3.0);
}

// A stroke of 0.6 m during which the carriage tilts about y and back, with a gyroscope.
CarriageRecord tilting_stroke(double tilt_rad) {
  CarriageRecord made = record({.strokes_m = {0.6}, .stroke_s = 4.0, .at_rest_mps2 = {0, 0, g}});
  std::mt19937_64 engine(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (auto& axis : made.sensor.rate_radps) axis.resize(made.sensor.time_s.size());
  for (std::size_t k = 0; k < made.sensor.time_s.size(); ++k) {
    const double s = (made.sensor.time_s[k] - 2.0) / 4.0;
    const bool moving = s > 0.0 && s < 1.0;
    const double bump =
        moving ? std::sin(std::numbers::pi * s) * std::sin(std::numbers::pi * s) : 0.0;
    const double tilt = tilt_rad * bump;
    const double rate =
        moving ? tilt_rad * std::numbers::pi / 4.0 * std::sin(2.0 * std::numbers::pi * s) : 0.0;
    const double a = made.accel_mps2[k];
    made.sensor.accel_mps2[0][k] = std::cos(tilt) * a - std::sin(tilt) * g + 0.02 * noise(engine);
    made.sensor.accel_mps2[2][k] = std::sin(tilt) * a + std::cos(tilt) * g + 0.02 * noise(engine);
    made.sensor.rate_radps[0][k] = 0.01 + 1e-3 * noise(engine);
    made.sensor.rate_radps[1][k] = -0.02 + rate + 1e-3 * noise(engine);
    made.sensor.rate_radps[2][k] = 1e-3 * noise(engine);
  }
  return made;
}

TEST(Track, AGyroscopeSeparatesGravityAndMotion) {
  // Tilts by 3°: without a gyroscope gravity contributes half a metre per second squared.
  const TrackSolution found = track(tilting_stroke(0.05));
  EXPECT_TRUE(found.axis_in_world);
  EXPECT_NEAR(std::abs(found.axis[0]), 1.0, 0.01);
  EXPECT_NEAR(found.smoother->displacement_m.value, 0.6, 3.0 * found.smoother->displacement_m.std);
  EXPECT_LT(found.smoother->displacement_m.std, 0.1);
  EXPECT_NEAR(found.smoother->displacement_m.value, 0.6, 0.05);
}

// Two intervals of 0.7 s; at the limit of a range they would turn gravity by 4°.
TEST(Track, BridgesMissingRatesOfAGyroscope) {
  CarriageRecord made = tilting_stroke(0.9);
  std::vector<double>& rate = made.sensor.rate_radps[1];
  const double limit = 0.85 * std::ranges::max(rate);
  for (double& one : rate)
    if (std::abs(one) > limit) one = no_value;
  const TrackSolution found = track(made);
  const Uncertain end = found.smoother->displacement_m;
  EXPECT_NEAR(end.value, 0.6, 3.0 * end.std);
}

}  // namespace
}  // namespace proofmass::estimate::track_test
