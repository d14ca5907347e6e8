#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A solution and its input.
struct WheelReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< notes of reading and preparation; the solution's are
                                    ///< added
  estimate::WheelOptions options;
  estimate::WheelSolution solution;
};

/// Turns, speed and distance, the sensors' constants, each method's count, consistency. Holds a
/// reference to the report, which must outlive it.
[[nodiscard]] Document describe(const WheelReport& report);

/// The whole time history as a recording with the columns time, angle, angle_std, speed, …; the
/// content of `--output`.
[[nodiscard]] Recording wheel_series(const WheelReport& report);

}  // namespace proofmass::report
