#pragma once

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

// Estimates of whole recordings, and what every one of them must satisfy.
namespace proofmass::estimate::test {

inline WheelSolution solve(const std::vector<WheelSensor>& sensors,
                           const WheelOptions& options = {}) {
  auto solution = estimate_wheel(sensors, options);
  EXPECT_TRUE(solution.has_value()) << solution.error().message;
  return std::move(solution).value();
}

/// The defaults with one change.
template <class Member, class Value>
WheelOptions with(Member member, const Value& value) {
  WheelOptions options;
  options.*member = value;
  return options;
}

/// Checks that every number of the series that is guaranteed to exist is finite.
inline void expect_finite(const WheelSolution& solution) {
  const WheelSeries& s = solution.series;
  for (const auto* column :
       {&s.time_s, &s.angle_rad, &s.angle_std_rad, &s.speed_radps, &s.speed_std_radps,
        &s.accel_radps2, &s.accel_std_radps2, &s.filtered_angle_rad, &s.filtered_angle_std_rad}) {
    EXPECT_EQ(column->size(), s.time_s.size());
    EXPECT_TRUE(std::ranges::all_of(*column, [](double x) { return std::isfinite(x); }));
  }
}

/// Checks that the turns are correct to `within` and within four of their own standard deviations.
inline void expect_turns(const WheelSolution& solution, double turns, double within) {
  ASSERT_TRUE(solution.turns.has_value());
  EXPECT_NEAR(solution.turns->value, turns, within);
  EXPECT_LT(std::abs(solution.turns->value - turns), 4.0 * solution.turns->std);
  EXPECT_GT(solution.turns->std, 0.0);
  EXPECT_LT(solution.turns->std, within);
  expect_finite(solution);
}

inline const Drive lively{{0.3, 0.0}, {{1.0, 0.0}, {3.0, 90 * rpm}, {3.0, 30 * rpm}, {2.0, 0.0}}};

}  // namespace proofmass::estimate::test
