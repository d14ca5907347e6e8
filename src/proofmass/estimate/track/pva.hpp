#pragma once

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track/motion.hpp"

// The models of `track` in which the acceleration is a state.
namespace proofmass::estimate {

/// Input from the inertial solution; the axis and the rests are in the solution itself.
struct PvaTask {
  const TrackSensor& sensor;
  const TrackSignal& signal;
  const AxisRun& run;
  TrackReadings readings;
};

/// Replaces the inertial solution by that of options.model: series, closures, consistency, jerk
/// density, fused results.
///
/// - The axis, the rests and the errors in motion are those of the inertial solution; the common
///   error of fused sensors is estimated anew, from their mean.
/// - Strokes keep the covariance of the inertial solution, i.e. of one sensor.
/// - The jerk density maximises the likelihood of all measurements of the first sensor, given the
///   noise at rest; its std is that of the likelihood's curvature.
/// - No effect for TrackModel::inertial.
///
/// Source: M. A. Lele (2010), sections 4.1.1 and 4.3, appendix A.1. Errors: invalid_argument (no
/// sensor beside the first or more than three, unequal lengths, an axis missing in one of them,
/// axes that are not parallel), too_few_samples. Cost: about thirty passes over the samples, at 0.5
/// µs each; 3 µs a sample to fuse.
[[nodiscard]] Status apply_track_model(const PvaTask& task,
                                       const TrackOptions& options,
                                       TrackSolution& solution);

}  // namespace proofmass::estimate
