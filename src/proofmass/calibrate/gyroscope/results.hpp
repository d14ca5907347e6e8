#pragma once

#include "proofmass/calibrate/gyroscope/fit.hpp"

// From the fitted matrix to the parameters, their covariance and what the recording lacks.
namespace proofmass::calibrate {

struct GyroscopeFit {
  RestRegression rests;
  MatrixFit matrix;
  bool latitude_known = false;
};

/// The calibration of a fit: estimates, shares of the covariance, residuals and reasons.
[[nodiscard]] GyroscopeCalibration gyroscope_results(const GyroscopeData& data,
                                                     const GyroscopeFit& fit,
                                                     const MultiPosition& accelerometer);

}  // namespace proofmass::calibrate
