#pragma once

#include <cmath>

#include "proofmass/core/units.hpp"
#include "proofmass/report/wheel/report.hpp"

// A synthetic solution with known figures, for the tests of this module.
namespace proofmass::report {

inline estimate::WheelSensorFit fake_sensor(const std::string& name) {
  estimate::WheelSensorFit fit;
  fit.name = name;
  fit.spin_axis = {0.0, 0.0, 1.0};
  fit.radius_m = Uncertain{0.1431, 0.0008};
  fit.bias_mps2 = {Uncertain{0.0213, 0.0007}, std::nullopt};
  fit.scale = {Uncertain{1.0021, 0.0001}, Uncertain{0.9987, 0.0001}};
  fit.mounting_rad = Uncertain{0.01, 0.002};
  fit.noise_mps2 = 0.021;
  fit.samples = 4000;
  fit.unusable = 3;
  fit.gated = 2;
  return fit;
}

/// A wheel that accelerates to −147 rpm and stops again, at 120 Hz for a hundred seconds.
inline WheelReport fake_report() {
  WheelReport report;
  report.inputs = {"wheel <1>.csv"};
  report.notes = {{Severity::info, "separator ','"},
                  {Severity::bad, "Acc_X: 3 values of 3e34 at 12.40 s … 12.43 s"}};
  estimate::WheelSolution& solution = report.solution;
  estimate::WheelSeries& series = solution.series;
  double angle = 0.3;
  constexpr double dt = 1.0 / 120.0;
  for (int k = 0; k < 12000; ++k) {
    const double t = k * dt, shake = std::sin(1.7 * k) * std::cos(0.31 * k);
    const double speed = -15.39 * std::pow(std::sin(t * 0.0314159), 2);
    angle += speed * dt;
    series.time_s.push_back(t);
    series.angle_rad.push_back(angle);
    series.angle_std_rad.push_back(2e-4 * (1.0 + 0.5 * std::cos(t * 0.0628)));
    series.speed_radps.push_back(speed);
    series.speed_std_radps.push_back(0.05 + 0.04 * std::sin(t * 0.5));
    series.accel_radps2.push_back(0.0);
    series.accel_std_radps2.push_back(0.1);
    series.filtered_angle_std_rad.push_back(4e-4 + 0.3 * std::exp(-t));
    series.filtered_angle_rad.push_back(angle + 0.5 * shake * series.filtered_angle_std_rad.back());
    series.atan2_angle_rad.push_back(angle + 0.02 * shake + 0.03 * std::sin(angle));
    series.double_integral_angle_rad.push_back(angle + 0.11 * t * t);
    series.nis.push_back(static_cast<float>(2.0 * std::pow(shake + 1.0, 4) + 0.01));
    series.channels_used.push_back(2);
    series.channels_gated.push_back(k > 5000 && k < 5040 ? 1 : 0);
  }
  solution.turns = Uncertain{-79.6141, 0.0021};
  solution.distance_m = Uncertain{71.52, 0.31};
  solution.distance_of = "wheel <1>.csv";
  solution.angle_final_rad = Uncertain{angle, 2e-4};
  solution.peak_speed_radps = Uncertain{-147.0 * radps_per_rpm, 0.05};
  solution.sensors = {fake_sensor("wheel <1>.csv")};
  solution.encoder = estimate::WheelEncoderFit{
      .name = "counts",
      .direction = -1.0,
      .offset_rad = Uncertain{0.4312, 0.0004},
      .errors_rad = {Uncertain{0.0041, 0.0002}, Uncertain{-0.0013, 0.0002}, std::nullopt,
                     std::nullopt},
      .noise_rad = 0.0004,
      .missed = {{61.2, 61.1, 61.4, -3}}};
  solution.smoother.turns = solution.turns;
  solution.ekf.turns = Uncertain{-79.6139, 0.004};
  solution.atan2 = {Uncertain{-79.612, 0.0}, "takes the hub's shaking for gravity"};
  solution.double_integration.note = "no radius is known well enough";
  estimate::ConsistencyCheck check({.channels = {"wheel <1>.csv along u"}, .rate_hz = 100.0});
  for (int k = 0; k < 24000; ++k) check.add(0, std::sin(7.0 * k * k), 0.5);
  solution.consistency = check.judge();
  solution.rejected_samples = 5;
  solution.rejected = {{41.67, 41.99, 5, "innovation beyond the gate"}};
  solution.not_observable = {
      "Radius and radial bias of wheel <1>.csv are one number at one speed."};
  solution.notes = {{Severity::warning, "the hub shakes by 0.4 m/s² rms"}};
  return report;
}

}  // namespace proofmass::report
