#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/calibrate/tumble_model.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/rests.hpp"

// From a recording on a table that stands still in places to positions.
namespace proofmass::calibrate {

struct SteadyAngleOptions {
  double rate_hz = 0.0;                   ///< 0: unknown
  std::optional<double> shortest_s = {};  ///< absent: 0.5 s; where the rate is unknown, 20 samples
};

/// The stretches in which the table's angle stays within a quarter of a degree and does not creep
/// (means of the first and last third within 0.03°), less a twentieth at either end. Cost: O(N).
[[nodiscard]] std::vector<Dwell> steady_angles(View<double> angle_rad,
                                               const SteadyAngleOptions& options);

/// Whether these angles are samples of a table that stops in places, rather than one row for each
/// position: at least 100 of them, and a step of a quarter of a degree at most every tenth, or a
/// steady angle. `rate_hz` 0: unknown.
[[nodiscard]] bool stops_in_places(View<double> angle_rad, double rate_hz);

/// Of each steady stretch the longest part in which the sensor lay still too: the table may still
/// move, or the sensor ring, where the angle shown is that of the setting already. A stretch
/// without such a part of six samples is left away.
[[nodiscard]] std::vector<Dwell> at_rest(View<Dwell> steady, View<signal::Rest> rests);

/// The mean of a channel over each dwell.
struct DwellOutputs {
  std::vector<double> mean, std;  ///< of each dwell; std of the mean, 0 where noise is not seen
  double noise_dof = 0.0;         ///< see PoseMeans
};

/// `lsb`: the converter's step, 0 if there is none. Errors: those of pose_means.
[[nodiscard]] Result<DwellOutputs> dwell_outputs(View<double> output,
                                                 View<Dwell> dwells,
                                                 double lsb = 0.0);

/// The mean angle over each dwell.
[[nodiscard]] std::vector<double> dwell_angles(View<double> angle_rad, View<Dwell> dwells);

}  // namespace proofmass::calibrate
