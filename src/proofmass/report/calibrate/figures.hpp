#pragma once

#include "proofmass/report/calibrate/report.hpp"
#include "proofmass/report/page/figure.hpp"

// The plots of a calibration's page.
namespace proofmass::report {

/// Residual and leave-one-out residual of each position, with ± 2 standard deviations of the noise.
/// Positions that contradict the others are labelled, at the edge of the plot if they are beyond
/// it.
[[nodiscard]] Figure residual_figure(const CalibrateReport& report);

/// Upward directions in the sensor's axes, as two hemispheres of equal areas, which shows uncovered
/// directions.
[[nodiscard]] Figure direction_figure(const CalibrateReport& report);

/// Bias and scale against the supply, as changes from the reference supply, with their fits.
/// Precondition: the report has supplies.
[[nodiscard]] Figure supply_bias_figure(const CalibrateReport& report);
[[nodiscard]] Figure supply_scale_figure(const CalibrateReport& report);

}  // namespace proofmass::report
