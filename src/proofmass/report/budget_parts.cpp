#include <cmath>
#include <numbers>

#include "proofmass/report/budget_report.hpp"

namespace proofmass::report {
namespace {

using sensor::AccelerometerPart;
using sensor::PartFigure;

std::optional<double> std_of(const std::optional<PartFigure>& figure) {
  return figure ? std::optional(figure->std()) : std::nullopt;
}

// Two-sided densities; what the datasheet does not state besides is 0, and mentioned in the method.
estimate::BudgetNoise noise_of(const AccelerometerPart& part) {
  return {.white_mps2_rthz = std_of(part.noise_mps2_rthz).value_or(0.0) / std::numbers::sqrt2,
          .flicker_mps2 = std_of(part.in_run_mps2).value_or(0.0)};
}

// Bias after a calibration: its change with temperature and over the long term, as far as stated.
std::optional<double> calibrated_bias_mps2(const AccelerometerPart& part, double change_k) {
  const auto drift = std_of(part.offset_mps2_per_k), term = std_of(part.repeatability_mps2);
  if (!drift && !term) return std::nullopt;
  return std::hypot(drift.value_or(0.0) * change_k, term.value_or(0.0));
}

double position_std_m(const AccelerometerPart& part, double bias_mps2, double t_s) {
  const std::vector<estimate::BudgetSensor> sensors{
      {.name = std::string(part.name), .bias_mps2 = {0.0, bias_mps2}, .noise = noise_of(part)}};
  return estimate::position_budget(sensors, std::vector<double>{t_s})
      .front()
      .errors.front()
      .position_m.std;
}

}  // namespace

std::vector<PartRow> part_rows(const std::vector<const AccelerometerPart*>& parts,
                               const std::vector<double>& times_s,
                               double temperature_change_k) {
  std::vector<PartRow> rows;
  for (const AccelerometerPart* part : parts) {
    PartRow& row = rows.emplace_back(PartRow{.part = part});
    const auto bias = calibrated_bias_mps2(*part, temperature_change_k);
    const char* no_noise = "the datasheet has no noise density";
    if (!part->noise_mps2_rthz)
      row.why_not_delivered = row.why_not_calibrated = row.why_not_between_rests = no_noise;
    else if (!part->offset_mps2)
      row.why_not_delivered = "the datasheet's offset is not in the table";
    if (part->noise_mps2_rthz && !bias)
      row.why_not_calibrated = "neither temperature coefficient nor repeatability is in the table";
    for (const double t_s : times_s) {
      PartError& error = row.errors.emplace_back(PartError{.t_s = t_s});
      if (row.why_not_delivered.empty())
        error.delivered_m = position_std_m(*part, part->offset_mps2->std(), t_s);
      if (row.why_not_calibrated.empty()) error.calibrated_m = position_std_m(*part, *bias, t_s);
      if (!row.why_not_between_rests.empty()) continue;
      const estimate::BudgetParts rests = estimate::distance_between_rests(noise_of(*part), t_s);
      error.between_rests_m = std::hypot(rests.white_m, rests.flicker_m, rests.random_walk_m);
    }
  }
  return rows;
}

}  // namespace proofmass::report
