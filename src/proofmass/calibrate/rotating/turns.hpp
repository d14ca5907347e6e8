#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/calibrate/rotation.hpp"

// Steady intervals of a rotating wheel's recording, and its initial phase.
namespace proofmass::calibrate {

/// A run of steady turns.
struct SteadyTurns {
  std::size_t recording = 0;
  std::size_t first = 0, last = 0;  ///< samples, last inside
  std::vector<double> turn_s;       ///< when each turn begins, and the last ends
};

struct FoundTurns {
  std::vector<SteadyTurns> sections;
  double recorded_s = 0.0, steady_s = 0.0;
  std::size_t turns = 0;  ///< steady or not
};

/// The unwrapped angle of an encoder.
[[nodiscard]] std::vector<double> counted_on(View<double> angle_rad);

/// Turns by the output of the first axis, from one rising crossing of its middle to the next (with
/// a hysteresis of 0.8 of its amplitude), or by the encoder's angle (unwrapped). Adds to `found`
/// the runs of at least 8 turns whose durations stay within 8 % of their neighbours', and in which
/// no sample is more than a sixteenth of a turn from the next.
void find_turns(const RotationRecording& recording, std::size_t number, FoundTurns& found);

}  // namespace proofmass::calibrate
