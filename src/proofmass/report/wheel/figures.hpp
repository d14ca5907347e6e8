#pragma once

#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of the wheel's page.
namespace proofmass::report {

/// Turns against time by each method. The range is that of the methods that stay near the smoother;
/// the label of double integration says where it ends if that is off the figure.
[[nodiscard]] Figure turns_figure(const estimate::WheelSolution& solution);

/// Angle of the plain methods minus the smoother's, in degrees.
[[nodiscard]] Figure plain_methods_figure(const estimate::WheelSolution& solution);

/// Filter minus smoother in degrees, with the 95 % bands of both about zero.
[[nodiscard]] Figure filter_figure(const estimate::WheelSolution& solution);

/// Standard deviation of the angle, in degrees, of filter and smoother.
[[nodiscard]] Figure angle_std_figure(const estimate::WheelSolution& solution);

/// Speed in rpm with its 95 % band.
[[nodiscard]] Figure speed_figure(const estimate::WheelSolution& solution);

/// Normalised innovations squared against time: the largest of each stretch, the 95 % point of χ²
/// with as many degrees of freedom as channels were used, and the instants with rejected readings.
[[nodiscard]] Figure innovations_figure(const estimate::WheelSolution& solution);

}  // namespace proofmass::report
