#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel/fit.hpp"

// An encoder on the axle as a further measurement of the wheel.
namespace proofmass::estimate {

/// The encoder's fixes on a time line, each attributed to the first epoch after it. Fixes older
/// than two steps, as in a gap, are left out.
[[nodiscard]] EncoderReadings encoder_readings(const WheelEncoder& encoder,
                                               const std::vector<double>& time_s);

/// Means over blocks of epochs, as averaged() of the sensors' measurements.
[[nodiscard]] EncoderReadings averaged(const EncoderReadings& encoder,
                                       const std::vector<double>& time_s,
                                       std::size_t each);

/// What the rounding to counts may add to each of the encoder's errors (c, s), n = 1 and 2, beyond
/// what it would as white noise: at a steady speed it repeats in step with the samples and may
/// resemble a few cycles a turn. Root mean square over positions of the counts of the regression on
/// the errors of the rounding that the estimated angles would have had. `own_rad`: the encoder's
/// own angle at each fix, as estimated; NaN where it has no fix. Cost: O(fixes).
[[nodiscard]] std::array<double, wheel::encoder_states - 1> coherent_rounding_rad(
    const EncoderReadings& encoder,
    const std::vector<double>& time_s,
    const std::vector<double>& own_rad);

struct EncoderTrack {
  WheelTrack track;
  WheelEncoder encoder;                   ///< without the missed counts
  std::vector<signal::CountSlip> missed;  ///< ascending
};

/// The track of one sensor's measurements along the encoder's angle, with the direction and zero at
/// which gravity rotates. Sets the measurements' variance and `readings.encoder`.
///
/// From a turn on, both axes are fitted by the encoder's motion together with the encoder's errors,
/// the sensor's delay (readings.delay_s is its prior and becomes the result) and the rolling radius
/// (readings.found_rolling_radius_m). What then remains against gravity, in sixteenths of a turn,
/// shows counts that were missed at once (signal::find_count_slips). Below a turn, the zero is that
/// of find_track(). Errors: not_observable (gravity does not rotate with the encoder's angle).
[[nodiscard]] Result<EncoderTrack> encoder_track(const WheelEncoder& encoder,
                                                 WheelReadings& readings);

}  // namespace proofmass::estimate
