#include "proofmass/calibrate/multi_position_budget.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/calibrate/uncertainty/type_b_effect.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

const std::optional<Uncertain>& parameter(const MultiPosition& fit, std::size_t k) {
  return k < 3 ? fit.bias[k] : k < 6 ? fit.scale[k - 3] : fit.misalignment_rad[k - 6];
}

std::string unit_of(std::size_t k, std::string_view reading_unit) {
  if (k < 3) return std::string(reading_unit);
  if (k >= 6) return "rad";
  return reading_unit == "m/s^2" ? "1" : fmt::format("{}/(m/s^2)", reading_unit);
}

// Gravity is the reference of every scale: u(g) is a line of its budget even if it is 0.
bool is_scale_by_gravity(const UncertaintyShare& share, std::size_t k) {
  return share.source == "gravity" && k >= 3 && k < 6;
}

// A share due to a single input: its own standard uncertainty and the sensitivity to it.
BudgetLine line_of_share(const UncertaintyShare& share,
                         const MultiPosition& fit,
                         std::size_t k,
                         const std::string& unit) {
  BudgetLine line{.source = share.source,
                  .type_a = share.type_a,
                  .distribution = share.dof > 0.0 ? Distribution::student_t : Distribution::normal,
                  .std = std::sqrt(share.covariance(static_cast<Index>(k), static_cast<Index>(k))),
                  .unit = unit,
                  .sensitivity = 1.0,
                  .dof = share.dof};
  if (is_scale_by_gravity(share, k)) {
    line.sensitivity = -fit.estimate[k] / fit.gravity_mps2;
    line.std /= std::abs(line.sensitivity);
    line.unit = "m/s^2";
  }
  return line;
}

Result<UncertaintyBudget> budget_of_one(const MultiPosition& fit,
                                        View<TypeBEffect> effects,
                                        std::size_t k,
                                        const std::string& unit) {
  std::vector<BudgetLine> lines;
  for (const UncertaintyShare& share : fit.shares)
    if (share.covariance(static_cast<Index>(k), static_cast<Index>(k)) > 0.0 ||
        is_scale_by_gravity(share, k))
      lines.push_back(line_of_share(share, fit, k, unit));
  for (const TypeBEffect& effect : effects) {
    BudgetLine line = effect.line;
    line.sensitivity = effect.sensitivity(static_cast<Index>(k));
    if (line.sensitivity != 0.0) lines.push_back(std::move(line));
  }
  return combine({parameter_names()[k], unit, fit.estimate[k]}, std::move(lines));
}

}  // namespace

const std::array<std::string, 9>& parameter_names() {
  static const std::array<std::string, 9> names{
      "bias x",  "bias y",          "bias z",          "scale x",        "scale y",
      "scale z", "misalignment yz", "misalignment zy", "misalignment zx"};
  return names;
}

Status add_type_b(MultiPosition& fit, View<TypeB> lines, std::string_view reading_unit) {
  const Result<std::vector<TypeBEffect>> effects = effects_of(fit, lines, reading_unit);
  if (!effects) return effects.error();
  for (const TypeBEffect& effect : *effects) {
    UncertaintyShare share{.source = effect.line.source, .type_a = false, .dof = effect.line.dof};
    share.covariance = effect.covariance();
    fit.covariance += share.covariance;
    fit.shares.push_back(std::move(share));
  }
  for (std::size_t k = 0; k < 9; ++k) {
    auto& figure = k < 3 ? fit.bias[k] : k < 6 ? fit.scale[k - 3] : fit.misalignment_rad[k - 6];
    if (figure)
      figure->std = std::sqrt(fit.covariance(static_cast<Index>(k), static_cast<Index>(k)));
  }
  return Done{};
}

Result<std::vector<UncertaintyBudget>> budget_of(const MultiPosition& fit,
                                                 View<TypeB> lines,
                                                 std::string_view reading_unit) {
  const Result<std::vector<TypeBEffect>> effects = effects_of(fit, lines, reading_unit);
  if (!effects) return effects.error();
  std::vector<UncertaintyBudget> budgets;
  for (std::size_t k = 0; k < 9; ++k) {
    if (!parameter(fit, k)) continue;
    Result<UncertaintyBudget> budget = budget_of_one(fit, *effects, k, unit_of(k, reading_unit));
    if (!budget) return budget.error();
    budgets.push_back(std::move(budget).value());
  }
  return budgets;
}

}  // namespace proofmass::calibrate
