#pragma once

#include <vector>

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt_axis.hpp"
#include "proofmass/report/figure.hpp"

namespace proofmass::report {

/// Roll, then pitch, with 95 % bands of the smoother and ticks where a reading lost weight.
[[nodiscard]] std::vector<Figure> tilt_figures(const estimate::TiltSolution& solution);

/// The angle with its bands, and the gyroscope's bias.
[[nodiscard]] std::vector<Figure> axis_tilt_figures(const estimate::AxisTiltSolution& solution);

/// Elevation of each axis against time, given all readings.
[[nodiscard]] Figure gravity_figure(const estimate::TiltSolution& solution);

/// Standard deviations of filter and smoother against time.
[[nodiscard]] Figure tilt_std_figure(const estimate::TiltSolution& solution);

}  // namespace proofmass::report
