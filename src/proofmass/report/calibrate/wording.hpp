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

/// One of the nine figures in display units: bias in mg, mV or counts, scale per g, angles in mrad.
struct CalibrationFigure {
  std::string key;      ///< "bias x", as parameter_names() has it
  std::string label;    ///< "Bias x"
  std::string unit;     ///< SI, as in the document
  std::string meaning;  ///< "output at 0 g"
  std::optional<Uncertain> figure;
  std::optional<double> half_width_95;  ///< absent if the std is unknown
  double factor = 1.0;                  ///< from SI to printed_unit
  std::string printed_unit;             ///< "mg", "mV/g", ""
};

/// All nine, in the order of the covariance.
[[nodiscard]] std::vector<CalibrationFigure> calibration_figures(const CalibrateReport& report);

/// "12.3 ± 0.2 mg"; the value alone if the noise is unknown; "not determined".
[[nodiscard]] std::string figure_words(const CalibrationFigure& figure, bool std_known);

/// A head, then rows of name, figure, 95 % interval (if known), and meaning or reason for absence.
[[nodiscard]] std::vector<std::vector<std::string>> figure_rows(const CalibrateReport& report);

/// True if the standard deviations include the noise of the means.
[[nodiscard]] bool stds_known(const CalibrateReport& report);

/// True if the directions of the positions are unknown and only |f| = g is used.
[[nodiscard]] bool has_free_directions(calibrate::PoseModel model);

/// "nine parameters", "six directions assumed exact".
[[nodiscard]] std::string model_words(calibrate::PoseModel model);

/// "0.062 mg", "21 µg".
[[nodiscard]] std::string mg_words(double accel_mps2);

/// "7 (x_up, 12.3–15.1 s)": one-based number, then label and time.
[[nodiscard]] std::string position_words(const CalibrateReport& report, std::size_t k);

/// A head, then one row for each position: number, time, direction, residual, leave-one-out,
/// studentised, verdict; empty columns are omitted.
[[nodiscard]] std::vector<std::vector<std::string>> position_rows(const CalibrateReport& report);

/// True if a note of the fit only gives the reason for an absent figure, which the figure's own
/// entry gives.
[[nodiscard]] bool is_reason_of_null(const std::string& note);

/// Reason for absent misalignment angles, from the notes of the fit.
[[nodiscard]] std::string why_no_misalignment(const calibrate::MultiPosition& fit);

/// "24 positions, nine parameters: accurate to 0.06 mg at rest (68 %).", with any contradicting
/// evidence.
[[nodiscard]] std::string calibrate_conclusion(const CalibrateReport& report);

/// Whether noise explains the residuals; empty if that is not testable.
[[nodiscard]] std::string lack_of_fit_sentence(const CalibrateReport& report);

/// One sentence for each suspect position, and one for each set of doubtful positions.
[[nodiscard]] std::vector<std::string> suspect_sentences(const CalibrateReport& report);
[[nodiscard]] std::string doubtful_sentence(const CalibrateReport& report);

/// "Next position: lay it with +z straight up; …", or that another would add little.
[[nodiscard]] std::string next_pose_sentence(const CalibrateReport& report);

/// Findings in addition to the conclusion, a sentence each.
[[nodiscard]] std::vector<std::string> calibrate_findings(const CalibrateReport& report);

}  // namespace proofmass::report
