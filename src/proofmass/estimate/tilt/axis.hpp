#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/consistency.hpp"

// One axis: an angle from an accelerometer and a gyroscope's rate about the same axis.
namespace proofmass::estimate {

struct AxisTiltRecord {
  std::vector<double> time_s;      ///< ascending
  std::vector<double> angle_rad;   ///< from the direction of the measured force; NaN: missing
  std::vector<double> rate_radps;  ///< NaN: missing
};

struct AxisTiltOptions {
  double rate_bias_std_radps = 0.1;  ///< initial bias of the gyroscope
  double rate_scale_std = 0.05;      ///< relative error of a rotation: scale, axis, lag
  Progress progress = {};
};

/// Noise parameters of the filter, by maximum likelihood.
struct AxisTiltNoise {
  double rate_noise_radps_rthz = 0.0;     ///< white
  double rate_bias_walk_radps_rts = 0.0;  ///< random walk of the bias
  double motion_std_rad = 0.0;            ///< error of the angle due to motion, correlated
  double motion_time_s = 0.0;             ///< its time constant
  double reading_std_rad = 0.0;           ///< white noise of the angle
  double log_likelihood = 0.0;
  bool converged = false;
};

/// One entry for each sample.
struct AxisTiltSeries {
  std::vector<double> time_s;
  std::vector<double> angle_rad, angle_std_rad;                    ///< given all measurements
  std::vector<double> filtered_angle_rad, filtered_angle_std_rad;  ///< given those up to the sample
  std::vector<double> rate_bias_radps, rate_bias_std_radps;        ///< given all measurements
  std::vector<float> weight;  ///< of the measured angle in the filter, 1: full
};

struct AxisTiltSolution {
  std::size_t samples = 0;
  std::size_t unusable = 0;       ///< samples without angle or rate
  std::size_t down_weighted = 0;  ///< measurements with a weight of one half or less
  Uncertain angle_rad{};          ///< at the last sample
  Uncertain rate_bias_radps{};    ///< at the last sample
  AxisTiltNoise noise{};
  Consistency consistency{};
  AxisTiltSeries series;
  std::vector<Note> notes;
};

/// The angle θ of a moving base, by filter and smoother over
///
///     θ' = θ + (ω − b) Δ + w_θ,   b' = b + w_b,   d' = e^(−Δ/τ) d + w_d,      z = θ + d + n,
///
/// with ω the gyroscope's rate, b its bias, and d the effect of the base's acceleration on the
/// accelerometer-derived angle z. All five noise parameters maximise the likelihood of the
/// innovations, which also determines the weight of the rate; w_θ includes the effect of the
/// gyroscope's scale error and delay on a rotation (tilt/gyroscope.hpp).
///
/// Errors: invalid_argument (unequal lengths, non-ascending time), too_few_samples (fewer than 50
/// with both). Cost: 1 µs a sample, and up to a second for the likelihood.
[[nodiscard]] Result<AxisTiltSolution> estimate_axis_tilt(const AxisTiltRecord& record,
                                                          const AxisTiltOptions& options);

}  // namespace proofmass::estimate
