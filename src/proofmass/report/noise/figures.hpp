#pragma once

#include "proofmass/report/noise/report.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of the noise page.
namespace proofmass::report {

/// Deviation against averaging time with its limits. If the statistic estimates the Allan
/// deviation, also the fitted sum and each identified term as a line, marked at its conventional τ:
/// N at 1 s, B in the flat part, K at 3 s, Q at √3 s, R at √2 s. Precondition: the channel has an
/// analysis.
[[nodiscard]] Figure deviation_figure(const ChannelNoise& channel);

/// One-sided density against frequency, with the fitted density, the noise floor and the names of
/// the lines. Precondition: the channel has an analysis.
[[nodiscard]] Figure parts_figure(const ChannelNoise& channel);

[[nodiscard]] Figure spectrum_figure(const ChannelNoise& channel);

}  // namespace proofmass::report
