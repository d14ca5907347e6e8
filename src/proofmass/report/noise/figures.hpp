#pragma once

#include "proofmass/report/noise/report.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of the noise page.
namespace proofmass::report {

/// Deviation against averaging time with its limits, and, where the statistic estimates the Allan
/// deviation, the fitted sum with each identified term as a line of its own, marked where it is
/// read: N at 1 s, B where the curve is flat, K at 3 s, Q at √3 s, R at √2 s. The channel has an
/// analysis.
[[nodiscard]] Figure deviation_figure(const ChannelNoise& channel);

/// One-sided density against frequency, with the fitted density, the floor and the lines' names.
/// The channel has an analysis.
[[nodiscard]] Figure parts_figure(const ChannelNoise& channel);

[[nodiscard]] Figure spectrum_figure(const ChannelNoise& channel);

}  // namespace proofmass::report
