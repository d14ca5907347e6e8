#pragma once

#include <array>
#include <optional>
#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Converts one sensor's channels to specific force in m/s^2:
///
/// - counts to volts by the LSB;
/// - volts to acceleration by sensitivity and zero (ratiometric: with the recorded supply, else the
///   nominal one);
/// - the reading by f = T diag(1/scale) (reading − bias); see Electrical and Calibration.
///
/// Channels in a unit of acceleration skip the first two steps; a calibration of volts or counts
/// skips the steps after its reading. Channels already past that reading are converted back by the
/// LSB, where possible. A missing figure counts as bias 0, scale 1. An axis that T needs and that
/// was not recorded counts as 0, with a note.
///
/// Errors: invalid_argument (a figure needed for the channel's unit is missing or zero, or the
/// units of bias and scale are inconsistent; the message names the channel). The recording is then
/// unchanged.
[[nodiscard]] Status apply(const SensorModel& model, const Triad& triad, Recording& recording);

/// The same for every accelerometer of the recording.
/// Errors: as above, and invalid_argument if there is none.
[[nodiscard]] Status apply(const SensorModel& model, Recording& recording);

/// Scales the voltages of a ratiometric sensor to its reference supply, V · V_ref / V_s, with the
/// recorded supply or, if no channel has it, the nominal one. Other channels are unchanged.
/// Errors: invalid_argument (the supply channel is missing, or not in volts). The recording is then
/// unchanged.
[[nodiscard]] Status bring_to_reference_supply(const Electrical& electrical,
                                               const Triad& triad,
                                               Recording& recording);

/// The SI unit of the reading that the calibration applies to: "m/s^2", "V" or "counts".
/// Errors: invalid_argument (inconsistent units of bias and scale, a scale of 0).
[[nodiscard]] Result<std::string> reading_unit(const Calibration& calibration);

/// T diag(1/scale), row by row; SI.
[[nodiscard]] std::array<std::array<double, 3>, 3> correction_matrix(
    const Calibration& calibration);

/// Standard deviation of the angle between the sensor's axes and its case, if the file has it.
[[nodiscard]] std::optional<double> alignment_std_rad(const SensorModel& model);

}  // namespace proofmass::sensor
