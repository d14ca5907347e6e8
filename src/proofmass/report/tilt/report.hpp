#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt/axis.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A solution and what it was computed from: roll and pitch, or the angle about one axis.
struct TiltReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< of reading and preparing; the solution's own are added
  Uncertain gravity_mps2{};
  bool reads_minus_g = false;  ///< the sensor reads −g upwards, and was turned round
  std::optional<estimate::TiltSolution> solution{};
  std::optional<estimate::AxisTiltSolution> axis{};
};

/// Roll and pitch with their rests and motion, or the angle about one axis.
[[nodiscard]] Document describe(const TiltReport& report);

/// Angles against time with their standard deviations, filtered and smoothed: what `--output`
/// writes.
[[nodiscard]] Recording tilt_series(const TiltReport& report);

/// All notes, those of the solution too.
[[nodiscard]] std::vector<Note> tilt_notes(const TiltReport& report);

}  // namespace proofmass::report
