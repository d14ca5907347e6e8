#pragma once

#include <string>
#include <vector>

#include "proofmass/calibrate/rotation.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct RotationReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  std::vector<std::string> axis_names;
  std::string unit;  ///< SI unit of the outputs: "V"; empty if unknown
  double gravity_mps2 = 0.0;
  calibrate::RotationFit fit;
};

/// Coefficients, outputs and residuals against the angle. Holds a reference to the report, which
/// must outlive it.
[[nodiscard]] Document describe(const RotationReport& report);

}  // namespace proofmass::report
