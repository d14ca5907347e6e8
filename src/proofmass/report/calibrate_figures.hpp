#pragma once

#include <vector>

#include "proofmass/report/calibrate_report.hpp"
#include "proofmass/report/figure.hpp"

// The plots of a calibration's page.
namespace proofmass::report {

/// Residual of each position, and by the others alone, with ± 2 standard deviations of the noise;
/// positions that contradict the others are named, at the edge where they lie beyond it.
[[nodiscard]] Figure residual_figure(const CalibrateReport& report);

/// Where upwards was in the sensor's axes, as two hemispheres of equal areas, so that gaps show.
[[nodiscard]] Figure direction_figure(const CalibrateReport& report);

/// Bias and scale against the supply, as changes from the reference supply, with their lines.
[[nodiscard]] std::vector<Figure> supply_figures(const CalibrateReport& report);

}  // namespace proofmass::report
