#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/report/tilt/report.hpp"

// Synthetic solutions with known figures, for the tests of this module.
namespace proofmass::report {

/// One rest of a hundred samples with zero roll; `moving`: by the filter of a moving base.
inline TiltReport fake_tilt(bool moving) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  TiltReport report;
  report.inputs = {"lying <1>.csv"};
  report.gravity_mps2 = {9.80665, 0.015};
  estimate::TiltSolution solution;
  solution.samples = 100;
  solution.axes = 3;
  solution.moving = moving;
  solution.final.why_no_roll = "the x axis is vertical";
  solution.final.pitch_rad = Uncertain{std::numbers::pi / 2, 0.01};
  for (int k = 0; k < 100; ++k) {
    solution.series.time_s.push_back(0.01 * k);
    for (auto* values : {&solution.series.pitch_rad, &solution.series.filtered_pitch_rad})
      values->push_back(1.5 + 1e-3 * k);
    for (auto* values : {&solution.series.pitch_std_rad, &solution.series.filtered_pitch_std_rad})
      values->push_back(0.01);
    for (auto* values :
         {&solution.series.roll_rad, &solution.series.roll_std_rad,
          &solution.series.filtered_roll_rad, &solution.series.filtered_roll_std_rad})
      values->push_back(none);
    solution.series.up[0].push_back(-1.0);
    solution.series.up[1].push_back(0.0);
    solution.series.up[2].push_back(0.0);
    solution.series.weight.push_back(k == 50 ? 0.1F : 1.0F);
    solution.series.resting.push_back(1);
  }
  solution.rests.push_back({.first = 0, .last = 99});
  solution.rests.back().angles = solution.final;
  solution.notes = {{Severity::warning, "the accuracy of the calibration is unknown"}};
  if (moving) {
    solution.motion = estimate::TiltMotion{.gyroscope = true, .drive = 1e-3};
    estimate::ConsistencyCheck check({.channels = {"x", "y", "z"}, .rate_hz = 100.0});
    for (int k = 0; k < 3000; ++k) check.add(static_cast<std::size_t>(k % 3), std::sin(k * k), 0.5);
    solution.consistency = check.judge();
  }
  report.solution = std::move(solution);
  return report;
}

/// One angle about one axis, 0.1 rad at the end.
inline TiltReport fake_axis_tilt() {
  TiltReport report;
  report.inputs = {"motor.dat"};
  estimate::AxisTiltSolution axis;
  axis.samples = 1;
  axis.angle_rad = {0.1, 0.01};
  report.axis = axis;
  return report;
}

}  // namespace proofmass::report
