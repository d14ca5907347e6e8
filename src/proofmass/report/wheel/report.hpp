#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/wheel.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A solution and what it was computed from.
struct WheelReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< of reading and preparing; the solution's own are added
  estimate::WheelOptions options;
  estimate::WheelSolution solution;
};

/// Turns, speed and distance, the sensors' constants, each method's count, consistency. It refers
/// to the report, which must outlive it.
[[nodiscard]] Document describe(const WheelReport& report);

/// The whole time line as a recording with the columns time, angle, angle_std, speed, …: what
/// `--output` writes.
[[nodiscard]] Recording wheel_series(const WheelReport& report);

}  // namespace proofmass::report
