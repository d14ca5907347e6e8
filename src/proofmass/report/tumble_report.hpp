#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/calibrate/tumble_axes.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::report {

/// One output on the table: its coefficients, or why there are none.
struct ChannelTumble {
  std::string name;
  Unit unit;  ///< of the outputs: SI where known, else counts or none
  calibrate::TumbleAxis axis;
  std::vector<calibrate::TumblePosition> positions;  ///< in its unit, those of the fit
  std::optional<calibrate::TumbleFit> fit;
  std::string refused;
};

/// A tumble test and what it was computed from.
struct TumbleReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<ChannelTumble> channels;
  std::size_t main = 0;     ///< the channel whose figures stand at the top of the document
  std::vector<Note> notes;  ///< of reading and preparing; those of the fits are added
  double gravity_mps2 = standard_gravity_mps2, gravity_std_mps2 = 0.0;
  std::optional<double> indexing_std_rad = {};  ///< as stated
  std::string source;  ///< where the positions came from: "a table of positions"
};

/// The document of `tumble`: docs/schema/tumble.schema.json.
[[nodiscard]] std::string tumble_json(const TumbleReport& report);

/// The page: conclusion, key figures, and for each channel output and residuals against angle, the
/// coefficients with what they are, and the conditions of the test.
[[nodiscard]] std::string tumble_html(const TumbleReport& report);

/// For a terminal, without colour, closed by a newline.
[[nodiscard]] std::string tumble_text(const TumbleReport& report);

/// "x: scale factor 0.3301 ± 0.0002 V/g, bias 12.1 ± 0.3 mg at 0 g."
[[nodiscard]] std::string tumble_conclusion(const TumbleReport& report);

/// All notes: the report's own, then each channel's with its name. A refusal is bad, that of an
/// axis along the table's only where no other channel has figures.
[[nodiscard]] std::vector<Note> tumble_notes(const TumbleReport& report);

/// Angle, direction, mounting and plane, then for each channel output, fit, residual and its
/// standard deviation: what `--output` writes.
[[nodiscard]] Recording tumble_series(const TumbleReport& report);

}  // namespace proofmass::report
