#include "proofmass/calibrate/gyroscope_budget.hpp"

#include <cmath>
#include <fmt/format.h>

namespace proofmass::calibrate {

std::string gyroscope_unit(std::size_t parameter, std::string_view reading_unit) {
  if (parameter < 3) return std::string(reading_unit);
  if (parameter < 6) return reading_unit == "rad/s" ? "1" : fmt::format("{}/(rad/s)", reading_unit);
  if (parameter < 12) return "rad";
  return fmt::format("{}/(m/s^2)", reading_unit);
}

std::vector<UncertaintyBudget> budget_of(const GyroscopeCalibration& fit,
                                         std::string_view reading_unit) {
  constexpr double least_share = 1e-6;  // of the variance: less is not worth a line
  std::vector<UncertaintyBudget> out;
  for (std::size_t k = 0; k < gyroscope_parameters; ++k) {
    const std::optional<Uncertain> figure = fit.parameter(k);
    if (!figure) continue;
    const auto at = static_cast<Eigen::Index>(k);
    const std::string unit = gyroscope_unit(k, reading_unit);
    std::vector<BudgetLine> lines;
    for (const GyroscopeShare& share : fit.shares) {
      const double variance = share.covariance(at, at);
      if (!(variance > least_share * fit.covariance(at, at))) continue;
      // The scatter of the axis itself, not the least of all three.
      const double dof = share.dof > 0.0 && (k < 3 || k >= 12) ? fit.dof[k] : share.dof;
      lines.push_back({.source = share.source,
                       .type_a = share.type_a,
                       .distribution = dof > 0.0 ? Distribution::student_t : Distribution::normal,
                       .std = std::sqrt(variance),
                       .unit = unit,
                       .sensitivity = 1.0,
                       .dof = dof});
    }
    out.push_back(
        combine({gyroscope_parameter_names()[k], unit, figure->value}, std::move(lines)).value());
  }
  return out;
}

}  // namespace proofmass::calibrate
