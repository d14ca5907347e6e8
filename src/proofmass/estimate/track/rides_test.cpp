#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "proofmass/estimate/track/rides_test_support.hpp"

namespace proofmass::estimate::track_rides_test {
namespace {

using rides::Draw;

void expect_held(const rides::Held& held) {
  EXPECT_EQ(held.given, held.recordings);
  EXPECT_GE(held.held, held.recordings - 1);
  EXPECT_EQ(held.wrong, 0);
}

// Constant speed is as quiet as rest, and so is constant acceleration.
TEST(TrackRides, CoverALiftWithoutVibration) {
  const auto held = rides::held_by([](Draw& draw) { return rides::lift(draw, 1, 0.0); }, 1, 12);
  expect_held(held);
  EXPECT_LT(held.rms_m(), 1.0);
}

TEST(TrackRides, ThreeRidesOfALiftAddUp) {
  expect_held(rides::held_by([](Draw& draw) { return rides::lift(draw, 3, 1.0); }, 1, 4));
}

TEST(TrackRides, ACartAtConstantSpeedDoesNotRest) {
  const auto held = rides::held_by(rides::cart, 1, 12);
  expect_held(held);
  EXPECT_LT(held.rms_m(), 0.2);
}

// On a tilted place the level is that of a constant acceleration, and its magnitude is that of
// gravity in both cases. These recordings had results off by 23, 19 and 8 standard deviations.
TEST(TrackRides, ARestOnATiltedPlaceIsNoConstantAcceleration) {
  const auto over_a_floor = [](Draw& draw) {
    return rides::over_a_floor(draw, 3.0 * std::numbers::pi / 180.0);
  };
  for (const std::uint64_t first : {84u, 85u, 92u}) {
    const rides::Held held = rides::held_by(over_a_floor, first, 1);
    EXPECT_EQ(held.given, held.held) << first;
  }
}

// For half a second gravity along a slope cancels the acceleration of a slow stroke, or a speed is
// constant by chance. These had results off by 8, 9, 9, 15 and 16 standard deviations.
TEST(TrackRides, AShortQuietStretchInASlowMotionIsNoRest) {
  const auto over_a_floor = [](Draw& draw) {
    return rides::over_a_floor(draw, std::numbers::pi / 180.0);
  };
  rides::Held held;
  for (const std::uint64_t first : {7004u, 7044u, 7241u}) {
    held = rides::held_by(over_a_floor, first, 1);
    EXPECT_EQ(held.given, held.held) << first;
  }
  for (const std::uint64_t first : {7132u, 7171u}) {
    held = rides::held_by(rides::shaken, first, 1);
    EXPECT_EQ(held.given, held.held) << first;
  }
}

// The velocities of both constant accelerations cancel, those of two tilts would not.
TEST(TrackRides, TheConstantAccelerationOfATrainIsNoTiltedPlace) {
  expect_held(rides::held_by([](Draw& draw) { return rides::train(draw, 1.0); }, 1, 6));
}

// A frame moving at constant speed is equivalent to one at rest.
TEST(TrackRides, ARecordingThatBeginsInMotionGivesAlternatives) {
  Draw draw(3);
  const rides::RideRecord made = rides::record(rides::begun_under_way(draw), draw);
  const TrackSolution found = estimate_track(made.sensor, {}).value();
  EXPECT_FALSE(found.smoother);
  ASSERT_GE(found.alternatives.size(), 2U);
  double sum = 0.0;
  bool holds_truth = false;
  for (const TrackAlternative& one : found.alternatives) {
    sum += one.probability;
    const double scale = 0.03 * std::abs(made.displacement_m);
    holds_truth = holds_truth || std::abs(one.displacement_m.value - made.displacement_m) <
                                     3.0 * one.displacement_m.std + scale;
  }
  EXPECT_LE(sum, 1.0 + 1e-9);
  EXPECT_TRUE(holds_truth);
}

TEST(TrackRides, StrongMotionAlongOneAxisIsNotARest) {
  const auto held = rides::held_by(rides::shaken, 1, 12);
  EXPECT_GE(held.given, 8);
  EXPECT_GE(held.held, held.given - 1);
  EXPECT_LE(held.wrong, 1);  // one of them happens to have constant speed for a second and a half
}

TEST(TrackRides, StrokesShorterThanHalfASecondAreKept) {
  const auto held = rides::held_by([](Draw& draw) { return rides::strokes(draw, 0.35); }, 1, 12);
  expect_held(held);
  EXPECT_LT(held.rms_m(), 0.01);
}

TEST(TrackRides, SlowStrokesBetweenShortRestsAreNotRests) {
  const auto held = rides::held_by(rides::slow_strokes, 1, 12);
  expect_held(held);
  EXPECT_LT(held.rms_m(), 0.03);
}

// Most of a slow move is as quiet as rest: the sensor accelerates evenly, or moves at an even
// speed. Of these, 21 had a result, of which three were off by more than ten standard deviations.
TEST(TrackRides, SlowMovesAreNoRests) {
  const auto held = rides::held_by(rides::slow_moves, 1, 24);
  EXPECT_GE(held.given, 18);
  EXPECT_GE(held.held, held.given - 2);
  EXPECT_EQ(held.wrong, 0);
}

// The gyroscope shows that the sensor does not turn, not that it does not move: with one, quiet
// intervals were rests without a question (lifts at constant speed 25 m off at 0.05 m).
TEST(TrackRides, AGyroscopeDoesNotMakeQuietIntervalsRests) {
  const auto lifts =
      rides::held_by(rides::with_gyro([](Draw& draw) { return rides::lift(draw, 1, 1.0); }), 1, 6);
  EXPECT_EQ(lifts.given, 6);
  EXPECT_GE(lifts.held, 5);
  EXPECT_EQ(lifts.wrong, 0);
  const auto moves = rides::held_by(rides::with_gyro(rides::slow_moves), 1, 12);
  EXPECT_GE(moves.given, 9);
  EXPECT_GE(moves.held, moves.given - 1);
  EXPECT_EQ(moves.wrong, 0);
}

// Without the accelerometer for more than a second the attitude is parted: this aborted.
TEST(TrackRides, AGapInTheAccelerationsBesideAGyroscopeIsAnError) {
  Draw draw(2);
  rides::Ride ride = rides::slow_moves(draw);
  ride.has_gyro = true;
  rides::RideRecord made = rides::record(ride, draw);
  for (auto& axis : made.sensor.accel_mps2)
    std::fill_n(axis.begin() + 600, 200, std::numeric_limits<double>::quiet_NaN());
  const auto found = estimate_track(made.sensor, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::not_observable);
}

// 3e34 beside a gyroscope was taken for motion: 0 ± 4e32 m.
TEST(TrackRides, AnImpossibleSampleBesideAGyroscopeIsMissing) {
  Draw draw(2);
  rides::Ride ride = rides::slow_moves(draw);
  ride.has_gyro = true;
  rides::RideRecord made = rides::record(ride, draw);
  const TrackSolution before = estimate_track(made.sensor, {}).value();
  std::fill_n(made.sensor.accel_mps2[0].begin() + 60, 5, 3e34);
  const TrackSolution found = estimate_track(made.sensor, {}).value();
  ASSERT_TRUE(before.smoother && found.smoother);
  EXPECT_NEAR(found.smoother->displacement_m.value, before.smoother->displacement_m.value,
              3.0 * before.smoother->displacement_m.std);
  EXPECT_LT(found.smoother->displacement_m.std, 2.0 * before.smoother->displacement_m.std);
}

// The level differs from rest to rest. The hypotheses were compared by different numbers of
// measurements, in favour of constant accelerations.
TEST(TrackRides, RestsOnAnAlmostLevelFloorAreRests) {
  const auto held = rides::held_by(
      [](Draw& draw) { return rides::over_a_floor(draw, 0.3 * std::numbers::pi / 180.0); }, 1, 24);
  EXPECT_GE(held.given, 22);
  EXPECT_GE(held.held, held.given - 1);
  EXPECT_LT(held.rms_m(), 0.085);
}

// Vibration in motion may be aliased and then contributes to the integral of the measurements.
TEST(TrackRides, VibrationInMotionIsInTheBand) {
  const auto held = rides::held_by([](Draw& draw) { return rides::lift(draw, 1, 6.0); }, 1, 12);
  EXPECT_EQ(held.given, 12);
  EXPECT_GE(held.held, 10);
  EXPECT_EQ(held.wrong, 0);
}

TEST(TrackRides, OnRequestOnlyTheEndsAreRests) {
  Draw draw(5);
  const rides::RideRecord made = rides::record(rides::lift(draw, 1, 0.0), draw);
  const TrackSolution found = estimate_track(made.sensor, {.only_end_rests = true}).value();
  EXPECT_EQ(found.rests.size(), 2U);
  ASSERT_TRUE(found.smoother.has_value());
  EXPECT_NEAR(found.smoother->displacement_m.value, made.displacement_m,
              found.smoother->half_width_95_m);
}

TEST(TrackRides, ASlideWithinTheNoiseIsNeverZeroAndSure) {
  const auto held = rides::held_by(rides::slow_slide, 1, 12);
  EXPECT_GE(held.held, held.given - 1);
  EXPECT_EQ(held.wrong, 0);
}

}  // namespace
}  // namespace proofmass::estimate::track_rides_test
