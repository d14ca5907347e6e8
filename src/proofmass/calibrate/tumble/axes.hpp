#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/core/view.hpp"

// Assignment of a sensor's axes to the components of gravity on a turntable.
namespace proofmass::calibrate {

/// Orientation of one output channel on the table.
struct TumbleAxis {
  /// In each plane: the multiple of 90° for which the output follows sin(angle + mount + phase);
  /// absent if the axis is parallel to the table's, or without positions.
  std::array<std::optional<double>, 2> phase_rad;
  double amplitude = 0.0;  ///< largest once-per-turn amplitude, unit of the output
  std::string words;       ///< "y follows cos(angle): 90° were added to its angles"

  [[nodiscard]] bool follows_angle() const { return phase_rad[0] || phase_rad[1]; }
};

/// Finds the phases of all channels of one sensor, `outputs` each as long as `positions` (whose own
/// outputs are not used). The channel `input`, if given, follows sin(angle) regardless of its
/// output. An axis lies in the plane of rotation if its amplitude exceeds a fifth of the largest.
/// If the positions of a second plane are not sufficient (0° and 180° alone), the first plane
/// decides: an axis that follows ± sin there is the input axis in both. Cost: O(positions ·
/// channels).
[[nodiscard]] std::vector<TumbleAxis> tumble_axes(View<TumblePosition> positions,
                                                  View<std::vector<double>> outputs,
                                                  std::optional<std::size_t> input = {});

}  // namespace proofmass::calibrate
