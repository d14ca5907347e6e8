#pragma once

#include "proofmass/estimate/wheel_fit.hpp"

// The two plain methods beside which the filter stands: what people do without one.
namespace proofmass::estimate {

/// Gravity's phase, unwrapped: atan2 of the measurements as they are, of two sensors their mean
/// after the second is turned into the first's axes. Nothing removes bias or centripetal force, so
/// far from the axle and fast it stops counting turns. As long as the time line; NaN before the
/// first reading.
[[nodiscard]] std::vector<double> atan2_angle(const WheelReadings& readings);

/// Where the plain methods take the sensors to be: where they were found or, where their direction
/// does not show, the first along its first axis and the second opposite. (u, v) of each; nothing
/// where a radius is missing.
struct PlainPlaces {
  Eigen::VectorXd places_m;
  bool taken = false;  ///< not all were found
};

[[nodiscard]] std::optional<PlainPlaces> plain_places(const std::vector<WheelSensorFit>& sensors,
                                                      double phase_rad);

/// The tangential acceleration over the radius, integrated twice from the smoother's first angle
/// and speed; of two sensors the mean, in which gravity cancels if they stand opposite and their
/// axes are parallel. Places as (u, v) of each sensor. Empty if a sensor sits on the axle.
[[nodiscard]] std::vector<double> double_integral_angle(const WheelReadings& readings,
                                                        const Eigen::VectorXd& places,
                                                        double start_angle_rad,
                                                        double start_speed_radps);

}  // namespace proofmass::estimate
