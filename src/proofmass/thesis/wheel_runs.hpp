#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel.hpp"
#include "proofmass/thesis/item.hpp"

// Sections 5.4 to 5.6: the rotating wheel, with the thesis's filter and with the wheel's own model.
namespace proofmass::thesis {

/// Prior of an axis's bias before the run: at the first sample b, later b + rise (1 − e^(−t/T)).
struct KnownBias {
  Uncertain start_mps2 = {0.0, 0.3};  ///< of an uncalibrated sensor
  double rise_mps2 = 0.0;
  double time_constant_s = 70.0;  ///< T
};

/// One run at one speed. Without a truth the smoothed wheel model replaces it, with its band.
struct WheelRecord {
  std::string source;  ///< the file, or "simulated"
  bool simulated = false;
  std::vector<estimate::WheelSensor> sensors;  ///< one or two
  bool clocks_shared = true;
  /// Distance of each sensor from the axle; absent: as estimated by the wheel model, if it is.
  std::optional<double> radius_m = 0.1;
  double speed_radps = 0.0;                         ///< as set; 0: unknown
  std::vector<std::array<KnownBias, 2>> bias = {};  ///< of each sensor's x and y; empty: unknown
  /// Angle of the first sensor's x axis above the horizontal, at the first sensor's samples; empty:
  /// unknown.
  std::vector<double> true_angle_rad = {}, true_speed_radps = {}, true_accel_radps2 = {};
};

struct WheelRunsOptions {
  std::uint64_t seed = 1;
  std::size_t seeds = 50;
  double gravity_mps2 = 0.0;
  Progress progress = {};
};

/// Figures 5.12 to 5.19 and section 6.1, and table A.1. `records` empty: simulated, `seeds` runs at
/// each of the thesis's speeds.
/// Errors: those of estimate_wheel(), with the recording's name.
[[nodiscard]] Result<std::vector<Item>> wheel_items(const std::vector<WheelRecord>& records,
                                                    const WheelRunsOptions& options);

}  // namespace proofmass::thesis
