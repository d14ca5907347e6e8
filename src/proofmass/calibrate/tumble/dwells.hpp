#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/rests.hpp"

// Positions from a recording on an indexed table.
namespace proofmass::calibrate {

struct SteadyAngleOptions {
  double rate_hz = 0.0;                   ///< 0: unknown
  std::optional<double> shortest_s = {};  ///< absent: 0.5 s; 20 samples if the rate is unknown
};

/// Intervals in which the table's angle stays within a quarter of a degree and does not creep
/// (means of the first and last third within 0.03°), minus a twentieth at either end. Cost: O(N).
[[nodiscard]] std::vector<Dwell> steady_angles(View<double> angle_rad,
                                               const SteadyAngleOptions& options);

/// Whether these angles are samples of a table that stops in places, rather than one row for each
/// position: at least 100 of them, and a step of a quarter of a degree at most every tenth, or a
/// steady angle. `rate_hz` 0: unknown.
[[nodiscard]] bool stops_in_places(View<double> angle_rad, double rate_hz);

/// The longest part of each steady interval in which the sensor is at rest too: the table may still
/// move, or the sensor ring, when the angle has already reached its setting. An interval without
/// such a part of six samples is omitted.
[[nodiscard]] std::vector<Dwell> at_rest(View<Dwell> steady, View<signal::Rest> rests);

/// The mean of a channel over each dwell.
struct DwellOutputs {
  std::vector<double> mean, std;  ///< of each dwell; std of the mean, 0 if no noise is visible
  double noise_dof = 0.0;         ///< see PoseMeans
};

/// `lsb`: the quantisation step, 0 if none. Errors: those of pose_means.
[[nodiscard]] Result<DwellOutputs> dwell_outputs(View<double> output,
                                                 View<Dwell> dwells,
                                                 double lsb = 0.0);

/// The mean angle over each dwell.
[[nodiscard]] std::vector<double> dwell_angles(View<double> angle_rad, View<Dwell> dwells);

}  // namespace proofmass::calibrate
