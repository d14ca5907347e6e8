#pragma once

#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of the wheel's page.
namespace proofmass::report {

/// Turns against time by each method. The range is that of the methods close to the smoother; if
/// double integration leaves it, its label states the final value.
[[nodiscard]] Figure turns_figure(const estimate::WheelSolution& solution);

/// Angle by the simpler methods minus the smoother's, in degrees.
[[nodiscard]] Figure plain_methods_figure(const estimate::WheelSolution& solution);

/// Filter minus smoother in degrees, with the 95 % bands of both about zero.
[[nodiscard]] Figure filter_figure(const estimate::WheelSolution& solution);

/// Standard deviation of the angle in degrees, by filter and smoother.
[[nodiscard]] Figure angle_std_figure(const estimate::WheelSolution& solution);

/// Speed in rpm with its 95 % band.
[[nodiscard]] Figure speed_figure(const estimate::WheelSolution& solution);

/// Normalised innovations squared against time: the largest of each interval, the 95 % point of χ²
/// with as many degrees of freedom as channels were used, and the epochs with rejected
/// measurements.
[[nodiscard]] Figure innovations_figure(const estimate::WheelSolution& solution);

}  // namespace proofmass::report
