#pragma once

#include "proofmass/report/page/figure.hpp"
#include "proofmass/report/track/report.hpp"

// The plots of a track's page, with rests shaded.
namespace proofmass::report {

/// Position along the axis by each method with 95 % bands, strokes and fixes marked. The range is
/// that of smoother and filter; if double integration leaves it, its label states the final value.
[[nodiscard]] Figure position_figure(const TrackReport& report);

/// Velocity with its 95 % band, and the residual velocity at the beginning of each stop.
[[nodiscard]] Figure velocity_figure(const estimate::TrackSolution& solution);

/// Acceleration along the axis, minus the level of the first rest.
[[nodiscard]] Figure accel_figure(const estimate::TrackSolution& solution);

/// Standard deviation of the position, by filter and smoother.
[[nodiscard]] Figure position_std_figure(const estimate::TrackSolution& solution);

}  // namespace proofmass::report
