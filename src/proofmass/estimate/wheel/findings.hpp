#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/wheel/fit.hpp"
#include "proofmass/estimate/wheel/plane.hpp"

// Results of a fit for the sensors: values where the recording determines them, words where not.
namespace proofmass::estimate {

/// Fills radius, mounting, bias, scale, skew and phase of each sensor; a value whose standard
/// deviation is not below half of its prior is absent.
void describe_sensors(const WheelFit& fit, double phase_rad, std::vector<WheelSensorFit>& sensors);

/// Fills the figures of the encoder; absent values as for the sensors.
void describe_encoder(const WheelFit& fit,
                      const EncoderReadings& readings,
                      std::size_t sensors,
                      WheelEncoderFit& encoder);

/// One sentence for each direction in which the recording hardly improves on the prior: the
/// eigenvectors of the covariance, in units of the prior, whose value is above a quarter. States
/// which quantities are not separable and what would separate them.
[[nodiscard]] std::vector<std::string> say_not_observable(
    const WheelFit& fit, const std::vector<WheelSensorFit>& sensors);

}  // namespace proofmass::estimate
