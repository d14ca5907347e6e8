#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt_axis.hpp"

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

/// The document of `tilt`: docs/schema/tilt.schema.json.
[[nodiscard]] std::string tilt_json(const TiltReport& report);

/// The page: conclusion, key figures, notes, angles against time, rests, how it was computed.
[[nodiscard]] std::string tilt_html(const TiltReport& report);

/// A screenful for a terminal, without colour, closed by a newline.
[[nodiscard]] std::string tilt_text(const TiltReport& report);

/// "Roll −3.21 ± 0.04°, pitch 0.50 ± 0.04°, over the last of 3 rests."
[[nodiscard]] std::string tilt_conclusion(const TiltReport& report);

/// "x points down, 3.0 ± 0.8° from the vertical, azimuth −142 ± 15° from y to z".
[[nodiscard]] std::string inclination_words(const estimate::TiltAngles& angles);

/// Angles against time with their standard deviations, filtered and smoothed: what `--output`
/// writes.
[[nodiscard]] Recording tilt_series(const TiltReport& report);

/// All notes, those of the solution too.
[[nodiscard]] std::vector<Note> tilt_notes(const TiltReport& report);

}  // namespace proofmass::report
