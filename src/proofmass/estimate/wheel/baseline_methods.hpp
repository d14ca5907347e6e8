#pragma once

#include "proofmass/estimate/wheel/fit.hpp"

// Two baseline methods without a filter, for comparison.
namespace proofmass::estimate {

/// Unwrapped gravity phase: atan2 of the raw measurements; for two sensors their mean after
/// rotating the second to the first's axes. Bias and centripetal force are not removed, so far from
/// the axle at high speed it stops counting turns. As long as the time line; NaN before the first
/// measurement.
[[nodiscard]] std::vector<double> atan2_angle(const WheelReadings& readings);

/// Lever arms assumed by the baseline methods: as estimated or, if their direction is not
/// observable, the first along its first axis and the second opposite. (u, v) of each; empty if a
/// radius is missing.
struct PlainPlaces {
  Eigen::VectorXd places_m;
  bool taken = false;  ///< not all were estimated
};

[[nodiscard]] std::optional<PlainPlaces> plain_places(const std::vector<WheelSensorFit>& sensors,
                                                      double phase_rad);

/// The tangential acceleration over the radius, integrated twice from the smoother's first angle
/// and speed; for two sensors the mean, in which gravity cancels if they are opposite with parallel
/// axes. Lever arms as (u, v) of each sensor. Empty if a sensor is on the axle.
[[nodiscard]] std::vector<double> double_integral_angle(const WheelReadings& readings,
                                                        const Eigen::VectorXd& places,
                                                        double start_angle_rad,
                                                        double start_speed_radps);

}  // namespace proofmass::estimate
