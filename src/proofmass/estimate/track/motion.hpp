#pragma once

#include <vector>

#include "proofmass/estimate/models/inertial_1d.hpp"
#include "proofmass/estimate/track.hpp"
#include "proofmass/estimate/track/epochs.hpp"
#include "proofmass/estimate/track/signal.hpp"

// The filter and the smoother over the measurements along one axis.
namespace proofmass::estimate {

/// One axis's measurements with all data of a run over them.
struct AxisRun {
  AxisEpochs made;
  LevelNoise level;
  InertialNoise noise;
  InertialStart start;
  /// That of the smoother, narrower: it multiplies the covariances of the filter by the information
  /// of all later measurements, and loses the digits by which the first exceed the result.
  InertialStart smoother_start;
  double longest_step_s = 0.0;  ///< between samples; a longer one is a gap
};

/// Densities from a sensor file, for one axis.
struct AxisNoise {
  std::optional<double> white_mps2_rthz, walk_mps2_rts;
};

/// Density along the axis, from those of the sensor's axes; absent if one is.
[[nodiscard]] std::optional<double> density_along(
    const std::array<std::optional<double>, 3>& figures, const std::array<double, 3>& axis);

/// Without the errors of motion.
[[nodiscard]] AxisRun prepare_axis(const TrackSignal& signal,
                                   View<double> accel_mps2,
                                   const TrackReadings& readings,
                                   const AxisNoise& known);

/// Position, velocity and bias at every epoch.
struct AxisPass {
  std::vector<Gaussian<3>> filtered, smoothed;
};
[[nodiscard]] AxisPass pass_over(const AxisRun& run);

/// The smoothed state at the first epoch within 30 of its standard deviations, which adds a
/// thousandth of the information; `start` if the recording begins at rest, or if the two disagree.
[[nodiscard]] InertialStart narrowed_start(const AxisRun& run);

struct FoundAxis {
  std::array<double, 3> direction{};
  double share = 1.0;
};

/// Direction with the largest mean square of the smoothed velocity; its largest component is
/// positive.
[[nodiscard]] FoundAxis farthest_axis(const TrackSignal& signal, const TrackReadings& readings);

/// The direction for given velocities, one vector for each of the three axes.
[[nodiscard]] FoundAxis farthest_axis(const std::vector<std::vector<double>>& velocity_mps,
                                      View<double> time_s,
                                      const std::vector<std::size_t>& axes);

}  // namespace proofmass::estimate
