#include "proofmass/estimate/track/stops.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

namespace proofmass::estimate::track_stops_test {
namespace {

constexpr double rate_hz = 100.0, noise_mps2 = 0.02;

/// One axis at rest at 9.8 m/s², with white noise.
std::vector<double> at_rest(double duration_s) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise(9.8, noise_mps2);
  std::vector<double> axis(static_cast<std::size_t>(duration_s * rate_hz));
  for (double& value : axis) value = noise(engine);
  return axis;
}

std::vector<signal::Rest> steady(const std::vector<double>& axis,
                                 const std::vector<signal::Rest>& rests) {
  const std::vector<View<double>> axes{axis};
  return steady_parts(axes, rests, rate_hz, 0.5);
}

/// Adds the part of one sine period between begin_s and end_s, as in a slow stroke.
void add_stroke(std::vector<double>& axis, double begin_s, double end_s, double peak_mps2) {
  for (std::size_t k = 0; k < axis.size(); ++k) {
    const double share = (static_cast<double>(k) / rate_hz - begin_s) / (end_s - begin_s);
    if (share > 0.0 && share < 1.0) axis[k] += peak_mps2 * std::sin(2.0 * std::numbers::pi * share);
  }
}

TEST(SteadyParts, ARestStaysWhole) {
  const std::vector<double> axis = at_rest(20.0);
  const auto parts = steady(axis, {{100, 1899}});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_LE(parts[0].first, 125U);  // one block at most by chance
  EXPECT_GE(parts[0].last, 1874U);
}

TEST(SteadyParts, AStretchWithoutReadingsDoesNotDivideIt) {
  std::vector<double> axis = at_rest(20.0);
  for (std::size_t k = 1000; k < 1060; ++k) axis[k] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(steady(axis, {{0, 1999}}).size(), 1U);
}

TEST(SteadyParts, ALevelThatDriftsDoesNotDivideIt) {
  std::vector<double> axis = at_rest(20.0);
  for (std::size_t k = 0; k < axis.size(); ++k) axis[k] += 5e-6 * static_cast<double>(k);
  EXPECT_EQ(steady(axis, {{0, 1999}}).size(), 1U);
}

TEST(SteadyParts, ASlowStrokeDividesIt) {
  std::vector<double> axis = at_rest(20.0);
  add_stroke(axis, 8.0, 12.0, 0.15);
  const auto parts = steady(axis, {{0, 1999}});
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts.front().first, 0U);
  EXPECT_LE(parts.front().last, 825U);
  EXPECT_GE(parts.back().first, 1175U);
  EXPECT_EQ(parts.back().last, 1999U);
}

TEST(SteadyParts, TheOnsetOfAMotionIsTakenOffTheEnd) {
  std::vector<double> axis = at_rest(20.0);
  add_stroke(axis, 9.0, 14.0, 0.03);
  const auto parts = steady(axis, {{0, 999}});  // the last second is in motion
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_LE(parts[0].last, 949U);
  EXPECT_GE(parts[0].last, 849U);
}

// Adds jerk · t³ / (6 s) from begin_s to end_s: an acceleration that begins imperceptibly.
void add_rise(std::vector<double>& axis, double begin_s, double end_s, double jerk_mps3) {
  for (std::size_t k = 0; k < axis.size(); ++k) {
    const double t = static_cast<double>(k) / rate_hz - begin_s;
    if (t > 0.0 && t < end_s - begin_s) axis[k] += jerk_mps3 * t * t * t / 6.0;
  }
}

// In the first 0.2 s the acceleration is at most an eighth of the noise, yet a velocity of 0 at
// the end of that would be off by a tenth of a millimetre per second for the whole motion.
TEST(SteadyParts, AHiddenOnsetIsTakenOffTheEnd) {
  std::vector<double> axis = at_rest(20.0);
  add_rise(axis, 9.8, 12.0, 2.0);
  const auto parts = steady(axis, {{0, 999}});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_LE(parts[0].last, 985U);
  EXPECT_GE(parts[0].last, 950U);
}

TEST(SteadyParts, ASuddenMotionLeavesTheRestWhole) {
  std::vector<double> axis = at_rest(20.0);
  for (std::size_t k = 1000; k < 1100; ++k) axis[k] += 3.0;
  const auto parts = steady(axis, {{0, 999}, {1100, 1999}});
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].last, 999U);
  EXPECT_EQ(parts[1].first, 1100U);
}

TEST(SteadyParts, WhatIsLeftOfTheRecordingIsNoOnset) {
  const auto parts = steady(at_rest(20.0), {{3, 1996}});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].first, 3U);
  EXPECT_EQ(parts[0].last, 1996U);
}

// For half a second the acceleration of a slow motion is within the noise.
TEST(SteadyParts, AShortStretchBetweenSlowMotionsIsNoRest) {
  std::vector<double> axis = at_rest(20.0), sudden = axis;
  const auto bend = [](std::size_t k) {
    const double t = (static_cast<double>(k) - 1000.0) / rate_hz;
    return 0.5 * t * t * t;
  };
  for (std::size_t k = 850; k < 1150; ++k) axis[k] += bend(k);
  for (std::size_t k = 850; k < 1150; ++k) sudden[k] += k >= 970 && k < 1030 ? 0.0 : 1.0;
  const std::vector<signal::Rest> rests{{0, 700}, {970, 1029}, {1300, 1999}};
  EXPECT_EQ(steady(axis, rests).size(), 2U);
  EXPECT_EQ(steady(sudden, rests).size(), 3U);
}

}  // namespace
}  // namespace proofmass::estimate::track_stops_test
