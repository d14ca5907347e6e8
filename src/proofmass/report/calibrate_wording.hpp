#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/report/calibrate_report.hpp"

// How the results of `calibrate` read: figures, positions, sentences.
namespace proofmass::report {

inline constexpr double mg = 1e-3 * standard_gravity_mps2;
/// p-values below it are reported as a finding.
inline constexpr double some_p = 0.05;

/// One of the nine figures as people read it: bias in mg, mV or counts, scale per g, angles in
/// mrad.
struct CalibrationFigure {
  std::string key;      ///< "bias x", as parameter_names() has it
  std::string unit;     ///< SI: of the document
  std::string meaning;  ///< "reading at 0 g"
  std::optional<Uncertain> figure;
  std::optional<double> half_width_95;  ///< absent where no std is known
  double factor = 1.0;                  ///< from SI to what is printed
  std::string printed_unit;             ///< "mg", "mV/g", ""
};

/// All nine, in the order of the covariance.
[[nodiscard]] std::vector<CalibrationFigure> calibration_figures(const CalibrateReport& report);

/// "12.3 ± 0.2 mg"; the value alone where the noise is not known; "not determined".
[[nodiscard]] std::string figure_words(const CalibrationFigure& figure, bool std_known);

/// A head, then rows of name, figure, 95 % interval (where known), meaning or why there is none.
[[nodiscard]] std::vector<std::vector<std::string>> figure_rows(const CalibrateReport& report);

/// Whether the standard deviations hold the noise of the means.
[[nodiscard]] bool stds_known(const CalibrateReport& report);

/// "nine parameters", "six positions taken for exact".
[[nodiscard]] std::string model_words(calibrate::PoseModel model);

/// "readings at rest are good to 1.5 mg (68 %), most of it from gravity; …", or why that cannot be
/// told.
[[nodiscard]] std::string accuracy_words(const CalibrateReport& report);

/// "0.062 mg", "21 µg".
[[nodiscard]] std::string mg_words(double accel_mps2);

/// "7 (x_up, 12.3–15.1 s)": number from 1, then whatever helps to find it.
[[nodiscard]] std::string position_words(const CalibrateReport& report, std::size_t k);

/// "12.3–15.1 s", "samples 120–450", "" where no times are known.
[[nodiscard]] std::string time_words(const CalibrateReport& report, std::size_t k);

/// A head, then one row for each position: number, when, direction, residual, leave-one-out,
/// studentised, verdict; columns in which nothing stands are left away.
[[nodiscard]] std::vector<std::vector<std::string>> position_rows(const CalibrateReport& report);

/// Does noise explain the residuals; empty where nothing can tell.
[[nodiscard]] std::string lack_of_fit_sentence(const CalibrateReport& report);

/// A sentence for each position that contradicts the others, and one for those of which one does.
[[nodiscard]] std::vector<std::string> suspect_sentences(const CalibrateReport& report);
[[nodiscard]] std::string doubtful_sentence(const CalibrateReport& report);

/// "Next, lay it with +z straight up: …", or that nothing much is to be gained.
[[nodiscard]] std::string next_pose_sentence(const CalibrateReport& report);

/// What there is to say beside the conclusion, a sentence each.
[[nodiscard]] std::vector<std::string> calibrate_findings(const CalibrateReport& report);

}  // namespace proofmass::report
