#pragma once

#include "proofmass/report/calibrate/report.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of a calibration's page.
namespace proofmass::report {

/// Residual of each position and its leave-one-out residual, with ± 2 standard deviations of the
/// noise; positions that contradict the others are named, at the edge where they lie beyond it.
[[nodiscard]] Figure residual_figure(const CalibrateReport& report);

/// Upward directions in the sensor's axes, as two hemispheres of equal areas, so that gaps show.
[[nodiscard]] Figure direction_figure(const CalibrateReport& report);

/// Bias and scale against the supply, as changes from the reference supply, with their fits. The
/// report must have supplies.
[[nodiscard]] Figure supply_bias_figure(const CalibrateReport& report);
[[nodiscard]] Figure supply_scale_figure(const CalibrateReport& report);

}  // namespace proofmass::report
