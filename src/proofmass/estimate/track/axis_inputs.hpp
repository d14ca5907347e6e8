#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/models/pva_axis.hpp"
#include "proofmass/estimate/track/pva.hpp"

// Measurements of each accelerometer along the track's axis.
namespace proofmass::estimate {

struct AxisInput {
  std::string name;
  std::vector<double> accel_mps2;  ///< less its level at the first rest; NaN: no measurement
  double level_mps2 = 0.0;
  double white_m2ps3 = 0.0, walk_m2ps5 = 0.0;  ///< N², and the density of what drives the bias
  std::optional<double> warm_up_time_s;

  [[nodiscard]] PvaSensor reading(double rate_hz) const {
    return {accel_mps2, white_m2ps3 * rate_hz, walk_m2ps5, warm_up_time_s};
  }
};

/// For the model `fused` all sensors, the task's own first; else that one alone.
struct AxisInputs {
  std::vector<AxisInput> all;
  std::vector<PvaSample> samples;
};

/// Errors: as apply_track_model().
[[nodiscard]] Result<AxisInputs> axis_inputs(const PvaTask& task,
                                             const TrackOptions& options,
                                             const TrackSolution& solution);

}  // namespace proofmass::estimate
