#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// An entry that a sensor file can have, and its figure if present.
struct FigureSlot {
  std::string section, key;         ///< "calibration", "bias"
  std::optional<std::size_t> axis;  ///< 0, 1, 2; absent for a figure of the whole sensor
  std::optional<Figure> figure;

  /// "x", or "yz" for a misalignment; empty for a figure of the whole sensor.
  [[nodiscard]] std::string axis_name() const;
  /// "calibration.bias x"
  [[nodiscard]] std::string name() const;
};

/// All slots in the order of the file; the same for every model.
[[nodiscard]] std::vector<FigureSlot> figure_slots(const SensorModel& model);

}  // namespace proofmass::sensor
