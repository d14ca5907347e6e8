#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "proofmass/report/tumble/report.hpp"

// Synthetic tumble tests with known coefficients, for the tests of this module.
namespace proofmass::report {

/// Outputs in volts of an axis about 1.65 V; that of the sixth position is off by `off_v`.
inline ChannelTumble fake_channel(int count, double noise_v, double off_v = 0.0) {
  constexpr double g = standard_gravity_mps2;
  ChannelTumble out;
  out.name = "acc_x";
  out.unit = *parse_unit("V");
  out.axis.phase_rad[0] = 0.0;
  out.axis.words = "follows sin(angle)";
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / count;
    const double ai = g * std::sin(angle), ap = g * std::cos(angle);
    const double scatter = noise_v * std::sin(12.9898 * k * k + 1.0);
    out.positions.push_back(
        {.angle_rad = angle,
         .output = 1.65 + 0.0337 * (0.1 + ai + 2e-3 * ap) + scatter + (k == 5 ? off_v : 0.0),
         .label = "line " + std::to_string(k + 2)});
  }
  out.fit = calibrate::fit_tumble(out.positions, {.gravity_mps2 = g, .output_unit = "V"}).value();
  return out;
}

inline TumbleReport fake_tumble(ChannelTumble one) {
  TumbleReport report;
  report.inputs = {"table <1>.csv"};
  report.source = "a table of positions";
  report.channels.push_back(std::move(one));
  return report;
}

/// Outputs in two planes, in m/s², with every entry that a channel can have.
inline TumbleReport fake_full_tumble() {
  ChannelTumble one = fake_channel(12, 1e-4);
  one.unit = *parse_unit("m/s^2");
  one.axis.phase_rad[1] = 0.0;
  for (std::size_t k = 0; k < 12; ++k) {
    one.positions.push_back(one.positions[k]);
    one.positions.back().plane = 2;
  }
  one.positions.front().time_s = 0.0;
  one.positions.front().temperature = 20.0;
  one.fit = calibrate::fit_tumble(one.positions, {.gravity_mps2 = standard_gravity_mps2}).value();
  one.fit->lack_of_fit = calibrate::TumbleLackOfFit{"noise of the means", 1.0, 0.5, 3, 10.0};
  one.fit->shares.front().dof = 10.0;
  TumbleReport report = fake_tumble(std::move(one));
  report.channels.push_back(
      {.name = "acc_z", .unit = {}, .axis = {}, .positions = {}, .fit = {}, .refused = "level"});
  return report;
}

}  // namespace proofmass::report
