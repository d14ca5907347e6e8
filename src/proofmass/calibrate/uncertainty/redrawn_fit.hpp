#pragma once

#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_fit.hpp"
#include "proofmass/calibrate/uncertainty/redrawn_poses.hpp"

namespace proofmass::calibrate {

/// Calibrates replications of the poses of a calibration, by its model and without its search for
/// bad poses. With |f| = g the descent begins at the calibration itself: some microseconds a
/// replication, where calibrate_positions() takes milliseconds. May be called from several threads.
class RedrawnFit {
 public:
  /// The arguments must outlive it.
  RedrawnFit(const DrawnFrom& from, const MultiPositionOptions& options, const MultiPosition& fit);

  /// Bias, scale and misalignment; nullopt if the replication could not be calibrated.
  [[nodiscard]] std::optional<Parameters> operator()(View<Pose> drawn, double gravity_mps2) const;

 private:
  MultiPositionOptions options_;
  bool by_norm_;
  NormParameters free_ = NormParameters::nine;
  ReadingScale scale_;
  NormData data_;            // the poses of the calibration
  ResidualWeights weights_;  // those of the calibration, for all replications
  Parameters start_;         // the calibration, in the units of the fit
};

}  // namespace proofmass::calibrate
