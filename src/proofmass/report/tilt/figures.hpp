#pragma once

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt/axis.hpp"
#include "proofmass/report/page/figure.hpp"

namespace proofmass::report {

// Angles with the 95 % bands of filter and smoother, and ticks at down-weighted measurements.
[[nodiscard]] Figure roll_figure(const estimate::TiltSolution& solution);
[[nodiscard]] Figure pitch_figure(const estimate::TiltSolution& solution);
[[nodiscard]] Figure axis_angle_figure(const estimate::AxisTiltSolution& solution);

/// Smoothed bias of the gyroscope with its 95 % band.
[[nodiscard]] Figure rate_bias_figure(const estimate::AxisTiltSolution& solution);

/// Smoothed elevation of each axis.
[[nodiscard]] Figure gravity_figure(const estimate::TiltSolution& solution);

/// Standard deviations of filter and smoother.
[[nodiscard]] Figure tilt_std_figure(const estimate::TiltSolution& solution);

}  // namespace proofmass::report
