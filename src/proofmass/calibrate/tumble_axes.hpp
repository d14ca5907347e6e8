#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble_model.hpp"
#include "proofmass/core/view.hpp"

// Which axis of a sensor on a turntable feels which part of gravity.
namespace proofmass::calibrate {

/// One output channel's place on the table.
struct TumbleAxis {
  /// In each plane: the multiple of 90° for which the output grows with sin(angle + mount + phase);
  /// absent where the axis lies along the table's, or where there are no positions.
  std::array<std::optional<double>, 2> phase_rad;
  double swing = 0.0;  ///< largest amplitude at once a turn, unit of the output
  std::string words;   ///< "y follows cos(angle): 90° were added to its angles"

  [[nodiscard]] bool swings() const { return phase_rad[0] || phase_rad[1]; }
};

/// Finds the phases of all channels of one sensor, `outputs` each as long as `positions` (whose own
/// outputs are not looked at). The channel `input`, if given, follows sin(angle) whatever its
/// readings say. An axis swings where its amplitude is more than a fifth of the largest. Where
/// the positions of a second plane cannot tell (0° and 180° alone), the first plane decides: an
/// axis that follows ± sin there is the input axis in both.
/// Cost: O(positions · channels).
[[nodiscard]] std::vector<TumbleAxis> tumble_axes(View<TumblePosition> positions,
                                                  View<std::vector<double>> outputs,
                                                  std::optional<std::size_t> input = {});

}  // namespace proofmass::calibrate
