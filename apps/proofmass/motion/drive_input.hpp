#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/common_flags.hpp"
#include "input/wheel_input.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/drive.hpp"

// From the recordings of a vehicle to its wheels, frame and position fixes.
namespace proofmass::app {

/// Files that name a vehicle's recordings.
struct DriveFiles {
  std::vector<std::string> right, left;   ///< wheels of either side
  std::vector<std::string> front;         ///< which of them are on the steered axle
  std::string frame, gnss;                ///< empty: none
  std::optional<double> counts_per_turn;  ///< of encoders
};

struct DriveInput {
  std::vector<estimate::DriveWheel> wheels;  ///< those of the right first
  std::optional<estimate::DriveFrame> frame;
  std::optional<estimate::GnssFixes> fixes;
  /// Reading of each recording's clock, as the wheels, the frame and the fixes have it, at its
  /// first sample.
  std::vector<double> begin_s;
  std::vector<Note> notes;
};

/// Throws Failure.
[[nodiscard]] DriveInput drive_input(const DriveFiles& files,
                                     const InputFlags& flags,
                                     const GyroscopeUse& gyroscope,
                                     const OutputFlags& output);

}  // namespace proofmass::app
