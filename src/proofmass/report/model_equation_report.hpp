#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/cross_axis.hpp"
#include "proofmass/calibrate/model_fit.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

/// One output column with its fitted model equation.
struct ModelOutput {
  std::string name;
  std::string unit;  ///< SI unit of the output: "V"; empty if unknown
  std::vector<calibrate::ModelRow> rows;
  calibrate::ModelFit fit;
  /// √(δ_o² + δ_p²); present if both were requested and determined.
  std::optional<calibrate::CrossAxis> cross_axis;
};

struct ModelEquationReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  std::optional<double> gravity_mps2;  ///< present if accelerations are computed from angles
  std::vector<ModelOutput> outputs;
};

/// Coefficients, identifiable combinations and residuals. Holds a reference to the report, which
/// must outlive it.
[[nodiscard]] Document describe(const ModelEquationReport& report);

}  // namespace proofmass::report
