#pragma once

#include <vector>

#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/uncertainty_budget.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/report/calibrate/certificate.hpp"
#include "proofmass/report/fields.hpp"
#include "proofmass/report/page/page.hpp"

// The gyroscope in the document of `calibrate`.
namespace proofmass::report {

struct GyroscopeReport {
  Unit unit;  ///< of the readings: rad/s, V or counts
  calibrate::GyroscopeCalibration fit;
  std::vector<calibrate::UncertaintyBudget> budgets;  ///< of the determined parameters
};

/// The entries, as an object `gyroscope`.
[[nodiscard]] Field gyroscope_field(const GyroscopeReport& report);

/// Figures, then motions. They refer to the report, which must outlive them.
[[nodiscard]] std::vector<Section> gyroscope_sections(const GyroscopeReport& report);

/// Motions that were excluded, lack of fit, convergence.
[[nodiscard]] std::vector<Note> gyroscope_notes(const GyroscopeReport& report);

/// Adds the model and the budgets.
void add_to_certificate(const GyroscopeReport& report, CertificateData& data);

}  // namespace proofmass::report
