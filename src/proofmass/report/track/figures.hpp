#pragma once

#include "proofmass/report/page/figure.hpp"
#include "proofmass/report/track/report.hpp"

// The plots of a track's page. Rests are shaded in each.
namespace proofmass::report {

/// Position along the axis by each method with 95 % bands, strokes and fixes marked. The range is
/// the smoother's and the filter's; the label of double integration says where it ends if that is
/// off the figure.
[[nodiscard]] Figure position_figure(const TrackReport& report);

/// Velocity with its 95 % band, and what was left of it on arrival at each stop.
[[nodiscard]] Figure velocity_figure(const estimate::TrackSolution& solution);

/// Acceleration along the axis, less the level of the first rest.
[[nodiscard]] Figure accel_figure(const estimate::TrackSolution& solution);

/// Standard deviation of the position, of filter and smoother.
[[nodiscard]] Figure position_std_figure(const estimate::TrackSolution& solution);

}  // namespace proofmass::report
