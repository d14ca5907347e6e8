#pragma once

#include <vector>

#include "proofmass/calibrate/rotating/turns.hpp"

// The encoder's zero and the sensor's axes.
namespace proofmass::calibrate {

/// What the zero of the angle is related to.
enum class EncoderZero {
  sensor,  ///< the sensor's case: the first axis is level or vertical at whole quarter turns
  wheel,   ///< the wheel, by an angle common to all recordings
  none     ///< each recording counts from its own start
};

/// Relates the angles to gravity in the first axis if their zero is not that of the sensor: if the
/// axis is off by more than 0.05 rad in all recordings, the angle at which it is level becomes the
/// zero; of each recording, if they differ by more than a delay explains (0.3 rad).
[[nodiscard]] EncoderZero relate_zero(std::vector<RotationRecording>& recordings,
                                      const std::vector<SteadyTurns>& sections);

}  // namespace proofmass::calibrate
