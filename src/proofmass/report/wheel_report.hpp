#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/wheel.hpp"

namespace proofmass::report {

/// A solution and what it was computed from.
struct WheelReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< of reading and preparing; the solution's own are added
  estimate::WheelOptions options;
  estimate::WheelSolution solution;
};

/// The document of `wheel`: docs/schema/wheel.schema.json.
[[nodiscard]] std::string wheel_json(const WheelReport& report);

/// The page: conclusion, key figures, notes, plots, sensors, methods side by side.
[[nodiscard]] std::string wheel_html(const WheelReport& report);

/// A screenful for a terminal, without colour, closed by a newline.
[[nodiscard]] std::string wheel_text(const WheelReport& report);

/// "The wheel turned 79.614 ± 0.002 times backwards in 91.6 s; top speed 147 rpm."
[[nodiscard]] std::string wheel_conclusion(const estimate::WheelSolution& solution);

/// What the band of the angle holds for the sensors' filters, and what would narrow it.
[[nodiscard]] std::string wheel_delay(const WheelReport& report);

/// The whole time line as a recording with the columns time, angle, angle_std, speed, …: what
/// `--output` writes.
[[nodiscard]] Recording wheel_series(const WheelReport& report);

}  // namespace proofmass::report
