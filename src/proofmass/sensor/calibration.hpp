#pragma once

#include <array>
#include <optional>
#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// Turns one sensor's channels into specific force in m/s^2: counts by the LSB, volts by
/// sensitivity and zero (ratiometric: by the recorded supply, else the nominal one), and the
/// reading by f = T diag(1/scale) (reading − bias); see Electrical and Calibration. Channels in an
/// unit of acceleration skip the first two, and a calibration of volts or counts those that come
/// after its reading; channels that are past it already go back by the LSB, where that can be. An
/// axis without a figure has bias 0, scale 1; where T needs an axis that was not recorded, that
/// axis counts as 0 and a note says so.
///
/// Errors: invalid_argument (a figure is missing or zero that the channel's unit calls for, or bias
/// and scale are in units that do not go together; the message names the channel). The recording is
/// then as it was.
[[nodiscard]] Status apply(const SensorModel& model, const Triad& triad, Recording& recording);

/// The same for every accelerometer of the recording.
/// Errors: as above, and invalid_argument if there is none.
[[nodiscard]] Status apply(const SensorModel& model, Recording& recording);

/// Brings the voltages of a ratiometric sensor to its reference supply, V · V_ref / V_s with the
/// supply as recorded or, where no channel has it, the nominal one. Other channels stay.
/// Errors: invalid_argument (the channel that the supply is taken from is not there, or not in
/// volts). The recording is then as it was.
[[nodiscard]] Status bring_to_reference_supply(const Electrical& electrical,
                                               const Triad& triad,
                                               Recording& recording);

/// The SI unit of the reading that the calibration is of: "m/s^2", "V" or "counts".
/// Errors: invalid_argument (bias and scale are in units that do not go together, a scale of 0).
[[nodiscard]] Result<std::string> reading_unit(const Calibration& calibration);

/// T diag(1/scale), row by row; SI.
[[nodiscard]] std::array<std::array<double, 3>, 3> correction_matrix(
    const Calibration& calibration);

/// Standard deviation of the angle between the sensor's axes and its case, where the file gives it.
[[nodiscard]] std::optional<double> alignment_std_rad(const SensorModel& model);

}  // namespace proofmass::sensor
