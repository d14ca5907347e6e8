#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"

// One motion along one axis, seen by several accelerometers at once.
namespace proofmass::estimate {

/// One accelerometer's readings along the common axis, gravity taken off or left in the bias.
struct AxisSensor {
  std::string name;
  std::vector<double> accel_mps2;     ///< NaN where there is no reading
  double accel_variance_m2ps4 = 0.0;  ///< of one reading, positive
  double bias_mps2 = 0.0;             ///< at the start, as well as it is known
  double bias_std_mps2 = 0.0;         ///< how well
  double bias_psd_m2ps5 = 0.0;        ///< density of the white noise that drives its walk
  /// The bias is forgotten in this time (Gauss–Markov, about bias_mps2); not given: it walks.
  std::optional<double> bias_time_constant_s = std::nullopt;
};

/// A velocity or a position known at some of the samples: 0 at rest, a fix.
struct AxisReading {
  std::size_t sample = 0;
  double value = 0.0;
  double std = 0.0;  ///< positive
};

struct FusionOptions {
  double jerk_psd_m2ps5 = 0.0;         ///< two-sided density of the white jerk, positive
  Uncertain position_m = {};           ///< at the first sample
  Uncertain velocity_mps = {};         ///< at the first sample
  Uncertain accel_mps2 = {0.0, 10.0};  ///< at the first sample
  std::vector<AxisReading> velocities_mps = {};
  std::vector<AxisReading> positions_m = {};
};

/// Position, velocity and acceleration with their standard deviations, one entry a sample.
struct AxisMotion {
  std::vector<double> position_m, velocity_mps, accel_mps2;
  std::vector<double> position_std_m, velocity_std_mps, accel_std_mps2;
};

/// A motion as one set of sensors shows it.
struct AxisEstimate {
  AxisMotion filtered;               ///< given the readings so far
  AxisMotion smoothed;               ///< given every reading
  std::vector<Uncertain> bias_mps2;  ///< of each sensor at the last sample, in their order
  double log_likelihood = 0.0;
  double nis = 0.0;          ///< mean over the readings
  std::size_t readings = 0;  ///< behind nis
};

struct FusedMotion {
  AxisEstimate fused;
  std::vector<AxisEstimate> single;  ///< each sensor alone, in their order
  /// Mean variance of the best single sensor over that of the fused motion, smoothed.
  double position_gain = 1.0, velocity_gain = 1.0, accel_gain = 1.0;
};

inline constexpr std::size_t most_fused_sensors = 4;

/// Fuses up to four accelerometers that share one axis and one motion:
///
///     x = [p v a b₁ … bₙ],   z_i = a + b_i + v_i,
///
/// white jerk driving a, and each bias a random walk or a Gauss–Markov process of its own.
/// A missing reading costs only its own channel. Roll from y1 + y2 and pitch from x1 + x2 are two
/// calls with two sensors each. What the sensors' biases have in common cannot be told from
/// acceleration; the start, velocities or positions must say it.
///
/// Source: M. A. Lele (2010), appendix A.1, with one motion for each pair of axes.
/// Errors: invalid_argument (no sensor or more than four, lengths that differ, time that does not
/// ascend, a density, a variance or a std that is not positive, a reading outside), not_finite,
/// too_few_samples (fewer than 2). Cost: O(samples), about 1 µs a sample for two sensors.
[[nodiscard]] Result<FusedMotion> fuse_axis(const std::vector<double>& time_s,
                                            const std::vector<AxisSensor>& sensors,
                                            const FusionOptions& options);

}  // namespace proofmass::estimate
