#include <cstdio>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <ostream>
#include <string>

#include "proofmass/estimate/track/rides_test_support.hpp"

// The table of docs/methods/track.md: estimate_slow_test --gtest_filter='*TrackRides*'
namespace proofmass::estimate::track_rides_slow_test {
namespace {

using rides::Draw;
using rides::Ride;

constexpr double degree = std::numbers::pi / 180.0;

struct Kind {
  std::string name;
  std::function<Ride(Draw&)> make;
  double least_given = 0.9, least_held = 0.93;
  int most_wrong = 0;  ///< off by more than five standard deviations

  friend std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }
};

class TrackRides : public testing::TestWithParam<Kind> {};

TEST_P(TrackRides, HoldTheTruthOrGiveNoFigure) {
  constexpr int recordings = 400;
  const rides::Held held = rides::held_by(GetParam().make, 7000, recordings);
  std::printf("| %s | %d | %.0f %% | %.1f | %.3g m |\n", GetParam().name.c_str(), held.given,
              100.0 * held.share(), held.largest, held.rms_m());
  EXPECT_GE(held.given, GetParam().least_given * recordings);
  EXPECT_GE(held.share(), GetParam().least_held);
  EXPECT_LE(held.wrong, GetParam().most_wrong);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    TrackRides,
    testing::Values(
        Kind{"lift, no vibration", [](Draw& draw) { return rides::lift(draw, 1, 0.0); }},
        Kind{"lift, vibration as the noise", [](Draw& draw) { return rides::lift(draw, 1, 1.0); }},
        Kind{"lift, vibration 3 times", [](Draw& draw) { return rides::lift(draw, 1, 3.0); }},
        Kind{"three rides of a lift", [](Draw& draw) { return rides::lift(draw, 3, 0.0); }},
        Kind{"cart at constant speed", rides::cart},
        Kind{"begun under way", rides::begun_under_way, 0.0},
        Kind{"shaken along one axis", rides::shaken, 0.75},
        Kind{"slide within the noise", rides::slow_slide, 0.5},
        Kind{"slow strokes, short rests", rides::slow_strokes},
        // A move within the noise of a second's mean stays hidden in a rest.
        Kind{"slow moves", rides::slow_moves, 0.7, 0.9, 6},
        Kind{"lift with a gyroscope, vibration as the noise",
             rides::with_gyro([](Draw& draw) { return rides::lift(draw, 1, 1.0); })},
        Kind{"slow moves with a gyroscope", rides::with_gyro(rides::slow_moves), 0.7, 0.9, 10},
        Kind{"train", [](Draw& draw) { return rides::train(draw, 0.0); }},
        Kind{"train, vibration 3 times", [](Draw& draw) { return rides::train(draw, 3.0); }},
        Kind{"floor of 0.3 degrees",
             [](Draw& draw) { return rides::over_a_floor(draw, 0.3 * degree); }},
        Kind{"floor of 1 degree", [](Draw& draw) { return rides::over_a_floor(draw, degree); },
             0.5},
        Kind{"floor of 3 degrees",
             [](Draw& draw) { return rides::over_a_floor(draw, 3.0 * degree); }, 0.4},
        Kind{"strokes of 0.3 s", [](Draw& draw) { return rides::strokes(draw, 0.3); }},
        Kind{"strokes of 0.45 s", [](Draw& draw) { return rides::strokes(draw, 0.45); }},
        Kind{"strokes of 0.8 s", [](Draw& draw) { return rides::strokes(draw, 0.8); }}));

}  // namespace
}  // namespace proofmass::estimate::track_rides_slow_test
