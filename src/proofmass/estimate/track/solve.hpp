#pragma once

#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track/motion.hpp"
#include "proofmass/estimate/track/motion_noise.hpp"

// The track along one axis, for given rests.
namespace proofmass::estimate {

/// Axis, measurements and errors of motion, with the results of filter and smoother.
struct AlongAxis {
  FoundAxis axis;
  std::vector<double> accel_mps2;
  AxisRun run;
  MotionError error;
  AxisPass pass;
  std::vector<Closure> closures;
  Consistency consistency;
};

/// Errors: invalid_argument (an axis of zero length, or along a missing sensor axis).
[[nodiscard]] Result<AlongAxis> solve(const TrackSignal& signal, const TrackOptions& options);

/// Only axis, measurements and errors of motion.
[[nodiscard]] Result<AlongAxis> solve_errors(const TrackSignal& signal,
                                             const TrackOptions& options);

/// The sample nearest to a time.
[[nodiscard]] std::size_t sample_at(View<double> time_s, double t);

/// Rests, turns and fixes by sample.
[[nodiscard]] TrackReadings readings_of(const TrackSignal& signal, const TrackOptions& options);

/// All properties of the measurements that do not need integration.
[[nodiscard]] TrackSolution described(const TrackSignal& signal, const TrackOptions& options);

/// Fills the results of every sample.
void fill_series(const TrackSignal& signal,
                 const AxisRun& run,
                 const AxisPass& pass,
                 TrackSolution& solution);

}  // namespace proofmass::estimate
