#pragma once

#include "proofmass/report/page/figure.hpp"
#include "proofmass/report/tumble/report.hpp"

// The plots of a tumble's page.
namespace proofmass::report {

/// Output against the table's angle: measurements, and the fit for each plane and mounting.
[[nodiscard]] Figure tumble_output_figure(const ChannelTumble& channel);

/// Residuals against the angle with their 95 % band; suspects labelled.
[[nodiscard]] Figure tumble_residual_figure(const ChannelTumble& channel);

}  // namespace proofmass::report
