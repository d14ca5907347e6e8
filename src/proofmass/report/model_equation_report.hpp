#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/calibrate/model_fit.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// One output column and the model equation that was fitted to it.
struct ModelOutput {
  std::string name;
  std::string unit;  ///< of the output, SI: "V"; empty if unknown
  std::vector<calibrate::ModelRow> rows;
  calibrate::ModelFit fit;
  /// √(δ_o² + δ_p²), where both were asked for and determined.
  std::optional<calibrate::CrossAxis> cross_axis;
};

struct ModelEquationReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  std::optional<double> gravity_mps2;  ///< where accelerations follow from angles
  std::vector<ModelOutput> outputs;
};

/// Coefficients, identifiable combinations and residuals. It refers to the report, which must
/// outlive it.
[[nodiscard]] Document describe(const ModelEquationReport& report);

}  // namespace proofmass::report
