#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt/axis.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// A solution and its input: roll and pitch, or the angle about one axis.
struct TiltReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<Note> notes;          ///< notes of reading and preparation; the solution's are
                                    ///< added
  Uncertain gravity_mps2{};
  bool reads_minus_g = false;  ///< the sensor measures −g upwards; its sign was reversed
  std::optional<estimate::TiltSolution> solution{};
  std::optional<estimate::AxisTiltSolution> axis{};
};

/// Roll and pitch with their rests and motion, or the angle about one axis.
[[nodiscard]] Document describe(const TiltReport& report);

/// Angles against time with their standard deviations, filtered and smoothed; the content of
/// `--output`.
[[nodiscard]] Recording tilt_series(const TiltReport& report);

/// All notes, including those of the solution.
[[nodiscard]] std::vector<Note> tilt_notes(const TiltReport& report);

}  // namespace proofmass::report
