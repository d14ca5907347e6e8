#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/calibrate/tumble/axes.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// One output of the test: its coefficients, or the reason for their absence.
struct ChannelTumble {
  std::string name;
  Unit unit;  ///< unit of the outputs: SI if known, else counts or none
  calibrate::TumbleAxis axis;
  std::vector<calibrate::TumblePosition> positions;  ///< in `unit`; the positions of the fit
  std::optional<calibrate::TumbleFit> fit;
  std::string refused;
};

/// A tumble test and its input.
struct TumbleReport {
  std::vector<std::string> inputs;  ///< files, as the user named them
  std::vector<ChannelTumble> channels;
  std::size_t main = 0;     ///< channel with its coefficients at the top level of the document
  std::vector<Note> notes;  ///< notes of reading and preparation; those of the fits are added
  double gravity_mps2 = standard_gravity_mps2, gravity_std_mps2 = 0.0;
  std::optional<double> indexing_std_rad = {};  ///< as stated
  std::string source;                           ///< origin of the positions: "a table of
                                                ///< positions"
};

/// For each channel coefficients, output and residuals against angle; the conditions of the test.
/// Holds a reference to the report, which must outlive it.
[[nodiscard]] Document describe(const TumbleReport& report);

/// All notes: the report's, then each channel's with its name. A refusal is Severity::bad; that of
/// an axis parallel to the table's only if no other channel has coefficients.
[[nodiscard]] std::vector<Note> tumble_notes(const TumbleReport& report);

/// Angle, direction, mounting and plane, then for each channel output, fit, residual and its
/// standard deviation; the content of `--output`.
[[nodiscard]] Recording tumble_series(const TumbleReport& report);

}  // namespace proofmass::report
