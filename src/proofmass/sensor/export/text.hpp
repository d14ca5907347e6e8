#pragma once

#include <string>
#include <string_view>

#include "proofmass/sensor/sensor_model.hpp"

// Text functions shared by the exports.
namespace proofmass::sensor {

/// The text on one line, safe inside a comment: it cannot open, end or continue one.
[[nodiscard]] std::string comment_text(std::string_view text);

/// The sensor's name for a comment, or `otherwise` if it has none.
[[nodiscard]] std::string name_or(const SensorModel& model, std::string_view otherwise);

/// "x, z": the axes without that figure.
[[nodiscard]] std::string missing_axes(const AxisFigures& figures);

}  // namespace proofmass::sensor
