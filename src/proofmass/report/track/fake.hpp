#pragma once

#include <cmath>

#include "proofmass/core/random.hpp"
#include "proofmass/report/track/report.hpp"

// A synthetic solution with known figures, for the tests of this module.
namespace proofmass::report {

/// Three strokes of 0.4 m there and back and one of 0.2 m one way, each after a rest of 2 s.
inline TrackReport fake_track() {
  TrackReport report;
  report.inputs = {"stroke <1>.csv"};
  report.notes = {{Severity::info, "separator ','"}};
  report.options.fixes = {{3.0, 0.41, 0.01}};
  estimate::TrackSolution& solution = report.solution;
  estimate::TrackSeries& series = solution.series;
  constexpr double dt = 0.01, tau = 6.283185307179586;
  for (int k = 0; k < 1800; ++k) {
    const double t = k * dt, phase = std::fmod(t, 4.0) - 2.0;
    const bool moving = phase > 0.0 && t < 16.0, last = t > 12.0;
    const double w = moving ? tau * phase / (last ? 4.0 : 2.0) : 0.0, a = last ? 0.1 : 0.2;
    series.time_s.push_back(t);
    series.resting.push_back(moving ? 0 : 1);
    series.position_m.push_back(moving ? a * (1.0 - std::cos(w)) : (t >= 16.0 ? 0.2 : 0.0));
    series.velocity_mps.push_back(a * std::sin(w) * (last ? tau / 4.0 : tau / 2.0));
    series.accel_mps2.push_back(moving ? a * std::cos(w) * 9.0 : 0.0);
    series.position_std_m.push_back(0.002 + (moving ? 0.004 : 0.0));
    series.velocity_std_mps.push_back(moving ? 0.01 : 1e-4);
    series.filtered_position_m.push_back(series.position_m.back() + 0.003 * t);
    series.filtered_position_std_m.push_back(0.01 + 0.002 * t);
    series.filtered_velocity_mps.push_back(series.velocity_mps.back());
    series.double_integral_m.push_back(series.position_m.back() + 0.02 * t * t);
  }
  for (const std::size_t first : {0U, 400U, 800U, 1200U})
    solution.rests.push_back({first, first + 199});
  solution.rests.push_back({1600, 1799});
  const auto stroke_at = [&series](std::size_t first, std::size_t turn, std::size_t last) {
    estimate::Stroke stroke;
    stroke.first = first;
    stroke.turn = turn;
    stroke.last = last;
    stroke.start_s = series.time_s[first];
    stroke.turn_s = series.time_s[turn];
    stroke.end_s = series.time_s[last];
    return stroke;
  };
  for (const std::size_t first : {200U, 600U, 1000U}) {
    estimate::Stroke stroke = stroke_at(first, first + 100, first + 200);
    stroke.out_m = {0.4 + 1e-5 * static_cast<double>(first), 0.004};
    stroke.back_m = Uncertain{-0.401, 0.005};
    stroke.length_m = stroke.out_m;
    solution.strokes.push_back(stroke);
  }
  solution.strokes.push_back(stroke_at(1400, 1599, 1599));
  solution.strokes.back().out_m = solution.strokes.back().length_m = {0.2, 0.003};
  solution.axis = {0.0, 0.6, 0.8};
  solution.travel_share = 0.97;
  solution.gravity = estimate::GravityContent::present;
  solution.resting_norm_mps2 = 9.79;
  solution.turned_rad = 0.01;
  solution.factor_95 = 2.4;
  solution.scale_std = 0.003;
  solution.motion_error = {0.01, 0.02, 0.003};
  solution.budget = {.white_mps2_rthz = 0.002,
                     .walk_mps2_rts = 1e-4,
                     .longest_motion_s = 2.0,
                     .motion_s = 8.0,
                     .free_m = 0.9,
                     .worst_m = 0.003,
                     .end_m = 0.002};
  solution.smoother = {{0.2, 0.002}, 2.6, 0.01, {0.4, 0.006}, 0.0048};
  solution.kalman = {{0.254, 0.046}, 2.7, std::nullopt, {0.43, 0.03}, 0.11};
  solution.double_integration = {{6.68, 0.9}, 9.1, std::nullopt, {6.68, 0.9}, 2.2};
  estimate::ConsistencyCheck check({.channels = {"velocity at stops"}, .rate_hz = 1.0});
  Random random(7, "track report");
  for (int k = 0; k < 400; ++k) check.add(0, random.normal(), 1.0);
  solution.consistency = check.judge();
  for (const double start : {2.0, 6.0, 10.0, 14.0})
    solution.closures.push_back({start, start + 2.0, 0.012, 0.01, 0.63});
  solution.notes = {{Severity::warning, "only 97 % of the motion is along one axis"}};
  return report;
}

/// The same motion from two fused sensors.
inline TrackReport fake_fused() {
  TrackReport report = fake_track();
  estimate::TrackSolution& solution = report.solution;
  solution.model = estimate::TrackModel::fused;
  solution.jerk_psd_m2ps5 = Uncertain{12.0, 0.5};
  solution.fused = estimate::FusedTrack{
      {{"acc", {0.02, 1e-3}, {0.201, 0.003}}, {"acc<2>", {0.31, 1e-3}, {0.198, 0.0029}}}, 2.1};
  return report;
}

/// The same measurements under the jerk model.
inline TrackReport fake_jerk() {
  TrackReport report = fake_track();
  estimate::TrackSolution& solution = report.solution;
  solution.suspected_jerk = true;
  solution.smoother = solution.kalman = solution.double_integration = std::nullopt;
  solution.strokes.clear();
  solution.notes = {{Severity::bad, "the data behave like jerk"}};
  return report;
}

}  // namespace proofmass::report
