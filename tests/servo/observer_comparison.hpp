#pragma once

#include <array>
#include <span>

// The load's angle by servo::MotorObserver and by ContactBank, on the twin of the drive.
namespace proofmass::servo_comparison {

struct Scenario {
  const char* name;
  double backlash_rad = 0.012, load_coulomb_nm = 0.15, noise_mps2 = 0.013;
  bool is_slow = false;  ///< a sine of the voltage; otherwise steps from 25 V to −25 V
};

[[nodiscard]] std::span<const Scenario> scenarios();

/// Errors of the load's angle from when the motor leaves a flank until 0.2 s after it meets one.
struct Crossing {
  double rms_rad = 0.0;
  double coverage_95 = 0.0;
  double largest_z = 0.0;
};

struct Comparison {
  Crossing smooth, bank;
};

/// Recordings of 40 s each.
[[nodiscard]] Comparison compare(const Scenario& scenario, int recordings);

}  // namespace proofmass::servo_comparison
