#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/models/pva_axis.hpp"
#include "proofmass/estimate/track.hpp"

// The filter and the smoother over accelerometers along one axis.
namespace proofmass::estimate {

/// One entry for each sample.
struct PvaSeries {
  std::vector<double> position_m, position_std_m, velocity_mps, velocity_std_mps;
};

struct PvaPass {
  PvaSeries filtered, smoothed;
  std::vector<Uncertain> bias_mps2;  ///< b_i + c of each sensor at the last sample
  std::vector<Closure> closures;
  Consistency consistency;  ///< a channel for each sensor, one for stops, one for positions
};

struct PvaPassOptions {
  double speed_std_mps = 0.0;  ///< at the first sample
  double rate_hz = 1.0;
  std::vector<std::string> names = {};  ///< of the sensors
};

[[nodiscard]] PvaPass pass_over(const PvaAxis<1>& axis, const PvaPassOptions& options);
[[nodiscard]] PvaPass pass_over(const PvaAxis<static_cast<int>(most_fused_sensors)>& axis,
                                const PvaPassOptions& options);

}  // namespace proofmass::estimate
