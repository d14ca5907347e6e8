#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/consistency.hpp"

// One axis: an angle that an accelerometer gave, and a gyroscope's rate about the same axis.
namespace proofmass::estimate {

struct AxisTiltRecord {
  std::vector<double> time_s;      ///< ascending
  std::vector<double> angle_rad;   ///< from the direction of the measured force; NaN: no reading
  std::vector<double> rate_radps;  ///< NaN: no reading
};

struct AxisTiltOptions {
  double rate_bias_std_radps = 0.1;  ///< of the gyroscope's bias at the start
  double rate_scale_std = 0.05;      ///< relative error of a turn: scale, axis, lag
  Progress progress = {};
};

/// What the filter takes the sensors for, found by maximum likelihood.
struct AxisTiltNoise {
  double rate_noise_radps_rthz = 0.0;     ///< white
  double rate_bias_walk_radps_rts = 0.0;  ///< what the bias walks in the root of a second
  double motion_std_rad = 0.0;            ///< what motion adds to the angle, correlated
  double motion_time_s = 0.0;             ///< its time constant
  double reading_std_rad = 0.0;           ///< white noise of the angle
  double log_likelihood = 0.0;
  bool converged = false;
};

/// One entry for each sample.
struct AxisTiltSeries {
  std::vector<double> time_s;
  std::vector<double> angle_rad, angle_std_rad;                    ///< given all readings
  std::vector<double> filtered_angle_rad, filtered_angle_std_rad;  ///< given those up to it
  std::vector<double> rate_bias_radps, rate_bias_std_radps;        ///< given all readings
  std::vector<float> weight;  ///< that the filter gave the reading of the angle, 1: all
};

struct AxisTiltSolution {
  std::size_t samples = 0;
  std::size_t unusable = 0;     ///< without angle or rate
  std::size_t told_less = 0;    ///< readings that lost half of their weight or more
  Uncertain angle_rad{};        ///< at the last sample
  Uncertain rate_bias_radps{};  ///< at the last sample
  AxisTiltNoise noise{};
  Consistency consistency{};
  AxisTiltSeries series;
  std::vector<Note> notes;
};

/// The angle θ of a base that moves, by filter and smoother over
///
///     θ' = θ + (ω − b) Δ + w_θ,   b' = b + w_b,   d' = e^(−Δ/τ) d + w_d,      z = θ + d + n,
///
/// ω the gyroscope's rate, b its bias, and d what the acceleration of the base does to the angle z
/// that the accelerometer gives. All five figures of noise are those of largest likelihood of the
/// innovations, which also tells how far to believe the rate; w_θ counts besides what a gyroscope
/// off scale, or late, makes of a turn (tilt_gyroscope.hpp).
///
/// Errors: invalid_argument (lengths that differ, time that does not ascend), too_few_samples
/// (fewer than 50 with both). Cost: 1 µs a sample, and up to a second for the likelihood.
[[nodiscard]] Result<AxisTiltSolution> estimate_axis_tilt(const AxisTiltRecord& record,
                                                          const AxisTiltOptions& options);

}  // namespace proofmass::estimate
