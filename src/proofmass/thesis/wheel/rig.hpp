#pragma once

#include <array>
#include <cstdint>

#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/thesis/wheel_runs.hpp"

// The thesis's wheel on the simulated rig.
namespace proofmass::thesis {

/// Speeds of the thesis: of section 5.4, and those of table A.1 with the controller's currents.
inline constexpr std::array<double, 5> study_speeds_rpm{11.0, 14.0, 16.0, 18.0, 21.0};
inline constexpr std::array<double, 6> setting_speeds_rpm{8.0, 11.0, 14.0, 16.0, 18.0, 21.0};
inline constexpr std::array<double, 6> setting_currents_a{2.0, 3.0, 4.0, 5.0, 6.0, 7.0};

inline constexpr double rig_rate_hz = 200.0;
inline constexpr double rig_radius_m = 0.1;  ///< of the sensors
inline constexpr double rim_radius_m = 0.15;
inline constexpr double rig_bandwidth_hz = 50.0;
inline constexpr double rig_ripple = 0.02;  ///< of the speed, once a turn
inline constexpr double ramp_s = 0.5;       ///< from rest to the speed

/// Noise of one sample of the ADXL335 after its filter, rms.
[[nodiscard]] double rig_noise_mps2();

struct RigRun {
  std::uint64_t seed = 1;
  double speed_radps = 11.0 * radps_per_rpm;
  double turns = 1.0;             ///< recorded, at least
  bool datasheet_errors = false;  ///< else noise, biases and warm-up only
  double gravity_mps2 = standard_gravity_mps2;
};

/// One run from rest, two opposite ADXL335, x of each outward and y forward, so that gravity
/// cancels in the sums of their signals as in (4.59); the start angle depends on the seed. Bias and
/// warm-up have the size of tables 5.1 and 4.1; their prior is the result of a tumble test on
/// another day, within 2 mg. Errors: invalid_argument. The same run gives the same numbers.
[[nodiscard]] Result<WheelRecord> simulate_wheel(const RigRun& run);

}  // namespace proofmass::thesis
