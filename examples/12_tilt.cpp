// Roll and pitch of a sensor at rest, and the contributions to their uncertainty: the calibration's
// share.
#include <cmath>
#include <cstdio>

#include "proofmass/core/random.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/tilt.hpp"

int main() {
  using namespace proofmass;
  // Ten seconds at 100 Hz, rotated by 5 degrees about x: y goes up.
  const double roll_rad = 5.0 * rad_per_deg;
  estimate::TiltRecord record;
  Random random(1, "noise");
  for (int k = 0; k < 1000; ++k) {
    record.time_s.push_back(0.01 * k);
    record.accel_mps2[0].push_back(0.01 * random.normal());
    record.accel_mps2[1].push_back(standard_gravity_mps2 * std::sin(roll_rad) +
                                   0.01 * random.normal());
    record.accel_mps2[2].push_back(standard_gravity_mps2 * std::cos(roll_rad) +
                                   0.01 * random.normal());
  }
  // A calibration with an uncertainty of 0.02 m/s² in each bias.
  estimate::TiltOptions options;
  options.calibration.emplace();
  options.calibration->bias = sensor::make_axis_figures({0.0, 0.0, 0.0}, "m/s^2", "example");
  for (auto& bias : options.calibration->bias) bias->std = 0.02;
  const estimate::TiltSolution tilt = estimate::estimate_tilt(record, options).value();
  const Uncertain roll = tilt.final.roll_rad.value();
  std::printf("roll %.3f ± %.3f degrees (noise %.4f, calibration %.3f)\n", roll.value / rad_per_deg,
              roll.std / rad_per_deg, tilt.shares.noise / rad_per_deg,
              tilt.shares.calibration / rad_per_deg);
  return std::abs(roll.value - roll_rad) < 3.0 * roll.std ? 0 : 1;
}
