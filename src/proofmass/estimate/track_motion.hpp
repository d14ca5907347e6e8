#pragma once

#include <vector>

#include "proofmass/estimate/inertial_axis.hpp"
#include "proofmass/estimate/track.hpp"
#include "proofmass/estimate/track_epochs.hpp"
#include "proofmass/estimate/track_signal.hpp"

// The filter and the smoother over the measurements along one axis. Private to the module's
// track*.cpp.
namespace proofmass::estimate {

/// One axis' measurements with all that a run over them needs.
struct AxisRun {
  AxisEpochs made;
  LevelNoise level;
  InertialNoise noise;
  InertialStart start;
  double longest_step_s = 0.0;  ///< between samples; a longer one is a gap
};

/// Densities that a sensor file knows, of one axis.
struct AxisNoise {
  std::optional<double> white_mps2_rthz, walk_mps2_rts;
};

/// A density along the axis, of figures for each of the sensor's; absent where one is.
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

struct FoundAxis {
  std::array<double, 3> direction{};
  double share = 1.0;
};

/// Along which the smoothed velocity has most of its square; its largest component is positive.
[[nodiscard]] FoundAxis farthest_axis(const TrackSignal& signal, const TrackReadings& readings);

/// The same of velocities that are known, one vector an axis of the three.
[[nodiscard]] FoundAxis farthest_axis(const std::vector<std::vector<double>>& velocity_mps,
                                      View<double> time_s,
                                      const std::vector<std::size_t>& axes);

}  // namespace proofmass::estimate
