#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/inertial_axis.hpp"
#include "proofmass/estimate/track.hpp"

// From samples and stops to the epochs of inertial_axis.hpp. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// How far the mean of a block of resting measurements is off, whatever their correlation: from the
/// scatter of successive blocks.
struct LevelNoise {
  std::size_t block = 1;  ///< samples
  double block_s = 0.0;
  double variance_m2ps4 = 0.0;   ///< of the mean of one block
  double walk_m2ps5 = 0.0;       ///< by which the level drifts at rest
  double sample_std_mps2 = 0.0;  ///< of one measurement about its block's mean
  /// N² of noise that is white from the length of a block on.
  [[nodiscard]] double white_m2ps3() const { return variance_m2ps4 * block_s; }
};

/// With Ā the half mean square of successive differences of block means, pooled over all rests
/// (Allan's variance): Ā(τ) = N²/τ + q τ/3 at τ and 4 τ give the two. Blocks are 0.5 s.
[[nodiscard]] LevelNoise level_noise(View<double> accel,
                                     const std::vector<signal::Rest>& rests,
                                     double rate_hz);

/// What is read beside the accelerometer, by sample.
struct TrackReadings {
  std::vector<signal::Rest> rests;  ///< ascending, apart
  double rest_speed_std_mps = 1e-3;
  struct Fix {
    std::size_t sample;
    double position_m, variance_m2;
  };
  std::vector<Fix> fixes;          ///< ascending
  std::vector<std::size_t> turns;  ///< ascending; the velocity is 0
};

/// The accelerations along one axis: NaN where there is no measurement.
struct AxisSignal {
  View<double> time_s, accel_mps2;
  double missing_std_mps2 = 0.0;  ///< how far an interpolated acceleration may be off
  double longest_step_s = 0.0;    ///< a longer step between samples is a gap
};

struct AxisEpochs {
  std::vector<InertialEpoch> epochs;
  std::vector<std::size_t> of_sample;  ///< which epoch tells of the sample
  /// Samples without a measurement that were passed over in one step, which ends at the epoch of
  /// each.
  struct Gap {
    std::size_t first, last;
    double unknown_accel_std_mps2;
  };
  std::vector<Gap> gaps{};
  /// Those at which something is read or after which another kind of step begins, and the last:
  /// what join_epochs() may keep alone.
  std::vector<std::size_t> knots;
};

[[nodiscard]] AxisEpochs axis_epochs(const AxisSignal& signal,
                                     const TrackReadings& readings,
                                     const LevelNoise& noise);

}  // namespace proofmass::estimate
