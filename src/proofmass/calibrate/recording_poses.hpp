#pragma once

#include <optional>
#include <vector>

#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"

// From a recording of an accelerometer that rests in several positions to its poses.
namespace proofmass::calibrate {

struct RecordingPosesOptions {
  std::vector<Dwell> dwells = {};         ///< the static intervals; empty: they are found
  std::optional<double> shortest_s = {};  ///< of those that are found: signal::RestOptions
};

struct RecordingPoses {
  Triad triad;                ///< the accelerometer
  Unit unit;                  ///< of the poses
  std::vector<Dwell> dwells;  ///< the static intervals of the poses
  PoseMeans means;            ///< its poses have the times of the recording
};

/// The only accelerometer of a recording, which has three axes.
/// Errors: invalid_argument (none, several, or fewer axes).
[[nodiscard]] Result<Triad> only_accelerometer(const Recording& recording);

/// The unit in which poses in `unit` are kept: m/s^2, V or counts.
/// Errors: invalid_argument (another quantity).
[[nodiscard]] Result<Unit> pose_unit(const Unit& unit);

/// The mean of the only accelerometer in each static interval, with its uncertainty by
/// pose_means(), in the SI unit of its channels; the converter's step is found in the samples.
/// Errors: invalid_argument (those of the above, or axes in different units), not_observable (no
/// static interval), too_few_samples (pose_means). Cost: that of signal::find_rests().
[[nodiscard]] Result<RecordingPoses> recording_poses(const Recording& recording,
                                                     const RecordingPosesOptions& options = {});

}  // namespace proofmass::calibrate
