#pragma once

#include <string>
#include <string_view>

#include "proofmass/sensor/sensor_model.hpp"

// Wording that the exports share.
namespace proofmass::sensor {

/// The text on one line, and harmless inside a comment: nothing in it opens, ends or continues one.
[[nodiscard]] std::string comment_text(std::string_view text);

/// The sensor's name for a comment, or else `otherwise`.
[[nodiscard]] std::string name_or(const SensorModel& model, std::string_view otherwise);

/// "x, z": the axes without that figure.
[[nodiscard]] std::string missing_axes(const AxisFigures& figures);

}  // namespace proofmass::sensor
