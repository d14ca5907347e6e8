#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/wheel.hpp"

// From one or two recordings of a turning wheel to its accelerometers.
namespace proofmass::app {

struct WheelInput {
  std::vector<estimate::WheelSensor> sensors;
  bool clocks_shared = true;
  double alignment_std_rad = 0.0;
  std::vector<Note> notes;
};

/// One or two accelerometers of one run, calibrated and in m/s^2. Throws Failure.
[[nodiscard]] WheelInput wheel_input(const std::vector<std::string>& files,
                                     const InputFlags& flags,
                                     const OutputFlags& output);

}  // namespace proofmass::app
