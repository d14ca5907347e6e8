#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/report/calibrate/report.hpp"

// Figures, positions and sentences of `calibrate`.
namespace proofmass::report {

inline constexpr double mg = 1e-3 * standard_gravity_mps2;
/// p-values below it are reported as a finding.
inline constexpr double some_p = 0.05;

/// The entries of the document.
[[nodiscard]] Fields calibrate_fields(const CalibrateReport& report);

/// One of the nine figures as people read it: bias in mg, mV or counts, scale per g, angles in
/// mrad.
struct CalibrationFigure {
  std::string key;      ///< "bias x", as parameter_names() has it
  std::string label;    ///< "Bias x"
  std::string unit;     ///< SI: of the document
  std::string meaning;  ///< "output at 0 g"
  std::optional<Uncertain> figure;
  std::optional<double> half_width_95;  ///< absent where no std is known
  double factor = 1.0;                  ///< from SI to what is printed
  std::string printed_unit;             ///< "mg", "mV/g", ""
};

/// All nine, in the order of the covariance.
[[nodiscard]] std::vector<CalibrationFigure> calibration_figures(const CalibrateReport& report);

/// "12.3 ± 0.2 mg"; the value alone where the noise is not known; "not determined".
[[nodiscard]] std::string figure_words(const CalibrationFigure& figure, bool std_known);

/// A head, then rows of name, figure, 95 % interval (where known), meaning or why it is absent.
[[nodiscard]] std::vector<std::vector<std::string>> figure_rows(const CalibrateReport& report);

/// Whether the standard deviations include the noise of the means.
[[nodiscard]] bool stds_known(const CalibrateReport& report);

/// Whether the directions of the positions are unknown, and only |f| = g is used.
[[nodiscard]] bool has_free_directions(calibrate::PoseModel model);

/// "nine parameters", "six directions assumed exact".
[[nodiscard]] std::string model_words(calibrate::PoseModel model);

/// "0.062 mg", "21 µg".
[[nodiscard]] std::string mg_words(double accel_mps2);

/// "7 (x_up, 12.3–15.1 s)": number from 1, then what identifies it.
[[nodiscard]] std::string position_words(const CalibrateReport& report, std::size_t k);

/// A head, then one row for each position: number, time, direction, residual, leave-one-out,
/// studentised, verdict; empty columns are omitted.
[[nodiscard]] std::vector<std::vector<std::string>> position_rows(const CalibrateReport& report);

/// Whether a note of the fit only states why a figure is absent, which the figure itself states.
[[nodiscard]] bool is_reason_of_null(const std::string& note);

/// Why the angles were not fitted, by the note of the fit.
[[nodiscard]] std::string why_no_misalignment(const calibrate::MultiPosition& fit);

/// "24 positions, nine parameters: accurate to 0.06 mg at rest (68 %).", and what contradicts it.
[[nodiscard]] std::string calibrate_conclusion(const CalibrateReport& report);

/// Whether noise explains the residuals; empty where that is not testable.
[[nodiscard]] std::string lack_of_fit_sentence(const CalibrateReport& report);

/// A sentence for each position that contradicts the others, and one for those of which one does.
[[nodiscard]] std::vector<std::string> suspect_sentences(const CalibrateReport& report);
[[nodiscard]] std::string doubtful_sentence(const CalibrateReport& report);

/// "Next position: lay it with +z straight up; …", or that it would add little.
[[nodiscard]] std::string next_pose_sentence(const CalibrateReport& report);

/// Findings beside the conclusion, a sentence each.
[[nodiscard]] std::vector<std::string> calibrate_findings(const CalibrateReport& report);

}  // namespace proofmass::report
