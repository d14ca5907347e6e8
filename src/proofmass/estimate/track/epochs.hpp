#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/models/inertial_1d.hpp"
#include "proofmass/estimate/track.hpp"

// From samples and stops to the epochs of models/inertial_1d.hpp.
namespace proofmass::estimate {

/// Error of the mean of a block of measurements at rest, for any correlation: from the scatter of
/// successive blocks.
struct LevelNoise {
  std::size_t block = 1;  ///< samples
  double block_s = 0.0;
  double variance_m2ps4 = 0.0;   ///< of the mean of one block
  double walk_m2ps5 = 0.0;       ///< drift of the level at rest
  double sample_std_mps2 = 0.0;  ///< of one measurement about its block's mean
  /// N² of noise that is white beyond the length of a block.
  [[nodiscard]] double white_m2ps3() const { return variance_m2ps4 * block_s; }
};

/// With Ā the half mean square of successive differences of block means, pooled over all rests (the
/// Allan variance), Ā(τ) = N²/τ + q τ/3 at τ and 4 τ gives the two. Blocks are 0.5 s.
[[nodiscard]] LevelNoise level_noise(View<double> accel,
                                     const std::vector<signal::Rest>& rests,
                                     double rate_hz);

/// Measurements other than the accelerometer's, by sample.
struct TrackReadings {
  std::vector<signal::Rest> rests;  ///< ascending, disjoint
  double rest_speed_std_mps = 1e-3;
  struct Fix {
    std::size_t sample;
    double position_m, variance_m2;
    double after_s = 0.0;  ///< time since that sample
  };
  std::vector<Fix> fixes;          ///< ascending
  std::vector<std::size_t> turns;  ///< ascending; the velocity is 0
};

/// The accelerations along one axis: NaN where missing.
struct AxisSignal {
  View<double> time_s, accel_mps2;
  double missing_std_mps2 = 0.0;  ///< how far an interpolated acceleration may be off
  double longest_step_s = 0.0;    ///< a longer step between samples is a gap
};

struct AxisEpochs {
  std::vector<InertialEpoch> epochs;
  std::vector<std::size_t> of_sample;  ///< epoch of each sample
  /// Samples without a measurement that are skipped in one step, and the epoch at which it ends.
  struct Gap {
    std::size_t first, last;
    double unknown_accel_std_mps2;  ///< of its mean
  };
  std::vector<Gap> gaps{};
  /// Epochs with a measurement or followed by another kind of step, and the last: the minimum that
  /// join_epochs() must keep.
  std::vector<std::size_t> knots;
};

[[nodiscard]] AxisEpochs axis_epochs(const AxisSignal& signal,
                                     const TrackReadings& readings,
                                     const LevelNoise& noise);

}  // namespace proofmass::estimate
