#pragma once

#include <string>
#include <vector>

#include "proofmass/calibrate/rotation.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::report {

struct RotationReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  std::vector<std::string> axis_names;
  std::string unit;  ///< of the readings, SI: "V"; empty if unknown
  double gravity_mps2 = 0.0;
  calibrate::RotationFit fit;
};

/// The document of `tumble --rotating`: docs/schema/tumble_rotating.schema.json.
[[nodiscard]] std::string rotation_json(const RotationReport& report);

/// Readings and residuals against the angle, folded over the turns, and the coefficients.
[[nodiscard]] std::string rotation_html(const RotationReport& report);

/// The coefficients for a terminal.
[[nodiscard]] std::string rotation_text(const RotationReport& report);

/// The unit of a coefficient of readings in this unit: "V/(m/s^2)".
[[nodiscard]] std::string rotation_unit(calibrate::RotationQuantity quantity,
                                        const std::string& reading_unit);

}  // namespace proofmass::report
