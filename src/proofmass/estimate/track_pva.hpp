#pragma once

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track_motion.hpp"

// The models of `track` in which the acceleration is a state. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// What they take from the inertial solution: the axis and the rests are in the solution itself.
struct PvaTask {
  const TrackSensor& sensor;
  const TrackSignal& signal;
  const AxisRun& run;
  TrackReadings readings;
};

/// Puts the solution of options.model instead of the inertial one: series, closures, consistency,
/// density of the jerk, fused figures. The axis, the rests and what the acceleration errs by in
/// motion are those of the inertial solution; what fused sensors all err by is found anew, from
/// their mean. Strokes keep the covariance of the inertial solution: that of one sensor. Does
/// nothing for TrackModel::inertial.
///
/// The density of the jerk maximises the likelihood of all measurements of the first sensor, given
/// the noise at rest; its std is that of the likelihood's curvature.
///
/// Source: M. A. Lele (2010), sections 4.1.1 and 4.3, appendix A.1. Errors: invalid_argument (no
/// sensor beside the first or more than three, lengths that differ, an axis that one of them lacks,
/// axes that are not parallel), too_few_samples. Cost: about thirty passes over the samples, at 0.5
/// µs each; 3 µs a sample to fuse.
[[nodiscard]] Status apply_track_model(const PvaTask& task,
                                       const TrackOptions& options,
                                       TrackSolution& solution);

}  // namespace proofmass::estimate
