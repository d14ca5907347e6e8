#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <string>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel_solution_test_support.hpp"

// Recordings of a wheel with gaps, corrupt rows and outliers.
namespace proofmass::estimate::wheel_gaps_test {
namespace {

using test::expect_turns;
using test::lively;
using test::record;
using test::solve;
using test::with;

// Two seconds without accelerometer data, in which a turn could be missed without the gyroscope.
TEST(EstimateWheel, AGyroscopeCountsThroughWhatTheAccelerometersMiss) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  test::Normal normal(5);
  for (const double t : sensor.time_s) {
    sensor.rate_radps[0].push_back(0.0);
    sensor.rate_radps[1].push_back(0.0);
    sensor.rate_radps[2].push_back(lively.at(t).speed_radps + 0.01 * normal());
  }
  for (std::size_t row = 180; row < 300; ++row)
    for (auto& axis : sensor.accel_mps2) axis[row] += 10.0 * normal();
  const auto solution = solve({sensor}, with(&WheelOptions::spin_axis, std::array{0.0, 0.0, 1.0}));
  expect_turns(solution, lively.turns(0.0, 9.0), 0.02);
}

TEST(EstimateWheel, BridgesAGapInWhichThePhaseCannotSlip) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  const auto hole = [](std::vector<double>& column) {
    if (!column.empty())
      column.erase(column.begin() + 240, column.begin() + 258);  // 0.3 s at 90 rpm
  };
  hole(sensor.time_s);
  for (auto& axis : sensor.accel_mps2) hole(axis);
  expect_turns(solve({sensor}), lively.turns(0.0, 9.0), 0.004);
}

TEST(EstimateWheel, AGapInWhichATurnMayHideHasNoTurns) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  const auto hole = [](std::vector<double>& column) {
    if (!column.empty()) column.erase(column.begin() + 120, column.begin() + 360);  // 4 s
  };
  hole(sensor.time_s);
  for (auto& axis : sensor.accel_mps2) hole(axis);
  const auto solution = estimate_wheel({sensor}, {});
  if (!solution.has_value()) return;  // an error message would be acceptable, too
  EXPECT_FALSE(solution->turns.has_value());
  EXPECT_TRUE(std::ranges::any_of(solution->notes, [](const Note& note) {
    return note.severity == Severity::bad && note.text.starts_with("turns: ");
  }));
}

TEST(EstimateWheel, AClockThatWasSetIsNamed) {
  WheelSensor sensor = record(lively, {}, 60.0, 9);
  for (std::size_t k = 200; k < sensor.time_s.size(); ++k) sensor.time_s[k] += 100.0;
  const auto solution = estimate_wheel({sensor}, {});
  ASSERT_FALSE(solution.has_value());
  EXPECT_EQ(solution.error().code, Errc::not_observable);
  EXPECT_TRUE(solution.error().message.find("no measurements from 3.3 to 103.3 s") !=
              std::string::npos)
      << solution.error().message;
}

// As a saturated accelerometer leaves out a part of each turn. Between the two sides of a gap the
// speed changes by more than jerk between samples.
TEST(EstimateWheel, WithAGyroscopeGapsAreBridgedAsWithout) {
  WheelSensor sensor = record(lively, {}, 60.0, 10);
  test::Normal normal(6);
  for (const double t : sensor.time_s) {
    for (auto& axis : sensor.rate_radps) axis.push_back(0.01 * normal());
    sensor.rate_radps[2].back() += lively.at(t).speed_radps;
  }
  for (std::size_t row = 100; row + 100 < sensor.time_s.size(); ++row)
    if (row % 60 < 10) sensor.accel_mps2[0][row] = no_value;
  const auto solution = solve({sensor});
  EXPECT_TRUE(solution.sensors[0].has_gyro);
  expect_turns(solution, lively.turns(0.0, solution.series.time_s.back()), 0.01);
}

TEST(EstimateWheel, SaysFromWhenToWhenItCounts) {
  WheelSensor sensor = record(lively, {}, 60.0, 10);
  const std::size_t size = sensor.time_s.size();
  for (std::size_t row = 0; row < size; ++row)
    if (row < 60 || row + 30 >= size) sensor.accel_mps2[1][row] = no_value;
  const auto solution = solve({sensor});
  const auto says = [&](Severity severity, const std::string& text) {
    return std::ranges::any_of(solution.notes, [&](const Note& note) {
      return note.severity == severity && note.text.find(text) != std::string::npos;
    });
  };
  EXPECT_TRUE(says(Severity::warning,
                   "the first 1.0 s have no usable measurements: turns and "
                   "angles count from 1.0"));
  EXPECT_TRUE(says(Severity::bad,
                   "the last 0.5 s have no usable measurements: turns and angles "
                   "count until 8.5 s, when the wheel was turning"));
  expect_turns(solution, lively.turns(1.0, sensor.time_s[size - 31]), 0.01);
}

TEST(EstimateWheel, ACorruptRowDoesNotAffectTheResult) {
  const WheelSensor clean = record(lively, {}, 60.0, 10);
  WheelSensor dirty = clean;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const std::array values{nan, infinite, 3e34, 1e-40, 0.0};
  for (std::size_t i = 0; i < 10; ++i) test::spoil(dirty, 30 + 50 * i, values[i % values.size()]);
  const auto expected = solve({clean}), solution = solve({dirty});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.004);
  ASSERT_TRUE(solution.turns && expected.turns);
  EXPECT_NEAR(solution.turns->value, expected.turns->value, 1e-3);
  EXPECT_EQ(solution.sensors[0].unusable, 10U);
  EXPECT_EQ(solution.rejected_samples, expected.rejected_samples + 10);
  std::size_t named = 0;
  for (const Stretch& stretch : solution.rejected) {
    EXPECT_TRUE(std::isfinite(stretch.start_s) && std::isfinite(stretch.end_s));
    if (stretch.reason.starts_with("sensor: ")) named += stretch.rows;
  }
  EXPECT_EQ(named, 10U);
}

// Outliers that the screening cannot recognise: beyond the gate, so that the filter rejects and
// counts them.
TEST(EstimateWheel, OutliersAreGatedAndCounted) {
  const WheelSensor clean = record(lively, {}, 60.0, 10);
  WheelSensor spoilt = clean;
  for (std::size_t i = 0; i < 5; ++i) spoilt.accel_mps2[0][40 + 90 * i] += 60.0;
  const auto solution = solve({spoilt});
  expect_turns(solution, lively.turns(0.0, 9.0), 0.005);
  EXPECT_GE(solution.rejected_samples, solve({clean}).rejected_samples + 5);
}

}  // namespace
}  // namespace proofmass::estimate::wheel_gaps_test
