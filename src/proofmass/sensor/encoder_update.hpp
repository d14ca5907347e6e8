#pragma once

#include <array>
#include <optional>
#include <string>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Result of an encoder's calibration.
struct MeasuredEncoder {
  std::optional<double> counts_per_turn;
  std::array<Uncertain, 4> errors_rad;  ///< once_cos, once_sin, twice_cos, twice_sin
  std::string origin;                   ///< "proofmass calibrate hub.csv --encoder, 40 turns"
};

/// The errors of an encoder as the file states them, if it has all four with their standard
/// deviations.
[[nodiscard]] std::optional<std::array<Uncertain, 4>> encoder_errors_rad(const Encoder& encoder);

/// Replaces the encoder in the model. Errors: not_finite, invalid_argument (a negative std). The
/// model is then unchanged.
[[nodiscard]] Status update_encoder(SensorModel& model, const MeasuredEncoder& measured);

/// The same in a sensor file; see update_calibration(path, …).
[[nodiscard]] Status update_encoder(const std::string& path, const MeasuredEncoder& measured);

}  // namespace proofmass::sensor
