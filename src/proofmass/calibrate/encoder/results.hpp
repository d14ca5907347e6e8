#pragma once

#include "proofmass/calibrate/encoder/fit.hpp"

// From the fit to harmonics with intervals and a budget.
namespace proofmass::calibrate {

/// Fills harmonics, covariance, shares and delay. `dof`: of type A.
void add_encoder_results(const EncoderRecording& recording,
                         const EncoderFit& fit,
                         double dof,
                         EncoderCalibration& out);

}  // namespace proofmass::calibrate
