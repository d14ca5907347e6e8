#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/position_budget.hpp"
#include "proofmass/report/document.hpp"
#include "proofmass/sensor/parts.hpp"

namespace proofmass::report {

/// A part in a job: standard deviations of the position after one time, or the reason why there is
/// none.
struct PartError {
  double t_s = 0.0;
  /// Double integration from rest, as delivered; with the bias calibrated at another temperature;
  /// and the distance between two rests.
  std::optional<double> delivered_m = {}, calibrated_m = {}, between_rests_m = {};
};

struct PartRow {
  const sensor::AccelerometerPart* part = nullptr;
  std::string why_not_delivered = {}, why_not_calibrated = {};  ///< empty: it is known
  std::string why_not_between_rests = {};
  std::vector<PartError> errors = {};
};

/// The parts' errors by their datasheets. `temperature_change_k`: since the calibration.
[[nodiscard]] std::vector<PartRow> part_rows(
    const std::vector<const sensor::AccelerometerPart*>& parts,
    const std::vector<double>& times_s,
    double temperature_change_k);

struct BudgetReport {
  std::vector<std::string> inputs;  ///< sensor files, if any
  std::vector<Note> notes;
  std::vector<estimate::BudgetRow> rows;
  std::vector<PartRow> parts = {};
  double temperature_change_k = 5.0;
};

/// Position error against time, as a table and as a figure. Holds a reference to the report, which
/// must outlive it.
[[nodiscard]] Document describe(const BudgetReport& report);

}  // namespace proofmass::report
