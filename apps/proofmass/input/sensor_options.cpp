#include "input/sensor_options.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/sensor/warm_up.hpp"

namespace proofmass::app {

std::optional<double> scale_std_of(const sensor::Calibration& calibration) {
  std::optional<double> largest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& scale = calibration.scale[axis];
    if (!scale || scale->si() == 0.0) continue;
    std::optional<double> std = scale->std_si();
    if (calibration.covariance) std = std::sqrt((*calibration.covariance)[3 + axis][3 + axis]);
    if (std) largest = std::max(largest.value_or(0.0), *std / std::abs(scale->si()));
  }
  return largest;
}

estimate::AccelFigures figures_of(const sensor::SensorModel& model, bool warm_up_removed) {
  estimate::AccelFigures figures;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& white = model.noise.white[axis];
    const auto& walk = model.noise.random_walk[axis];
    if (white && white->si() > 0.0) figures.white_mps2_rthz[axis] = white->si();
    if (walk) figures.walk_mps2_rts[axis] = std::abs(walk->si());
    if (!warm_up_removed) continue;
    if (const auto warm_up = sensor::warm_up_of(model.drift, axis))
      figures.warm_up_time_s[axis] = warm_up->time_constant_s;
  }
  return figures;
}

}  // namespace proofmass::app
