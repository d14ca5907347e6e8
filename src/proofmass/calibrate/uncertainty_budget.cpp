#include "proofmass/calibrate/uncertainty_budget.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>

#include "proofmass/calibrate/uncertainty/correlation.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

Status check(const Measurand& measurand, const std::vector<BudgetLine>& lines) {
  if (!std::isfinite(measurand.value))
    return Error{Errc::not_finite, fmt::format("{} is not a finite number", measurand.quantity)};
  for (const BudgetLine& line : lines) {
    if (!std::isfinite(line.std) || !std::isfinite(line.sensitivity) || !std::isfinite(line.dof))
      return Error{Errc::not_finite, fmt::format("{}: {}: a figure is not a finite number",
                                                 measurand.quantity, line.source)};
    if (line.std < 0.0 || line.dof < 0.0)
      return Error{Errc::invalid_argument,
                   fmt::format("{}: {}: expected a standard deviation and degrees of freedom of 0 "
                               "or more",
                               measurand.quantity, line.source)};
  }
  return Done{};
}

// Lines that correlation ties together, directly or by way of others, get the same number.
std::vector<std::size_t> groups_of(std::size_t count, const Eigen::MatrixXd& correlation) {
  std::vector<std::size_t> group(count);
  std::iota(group.begin(), group.end(), std::size_t{0});
  if (correlation.size() == 0) return group;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (correlation(static_cast<Index>(i), static_cast<Index>(j)) != 0.0)
        std::ranges::replace(group, std::max(group[i], group[j]), std::min(group[i], group[j]));
  return group;
}

// Σ_g u_g⁴ / ν_g, where `variances` are the lines' parts of u_c².
double fourth_powers(const std::vector<BudgetLine>& lines,
                     const Eigen::VectorXd& variances,
                     const std::vector<std::size_t>& group) {
  std::vector<double> variance(lines.size(), 0.0), dof(lines.size(), 0.0);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t g = group[i];
    variance[g] += variances(static_cast<Index>(i));
    if (lines[i].dof > 0.0 && lines[i].contribution() != 0.0)
      dof[g] = dof[g] > 0.0 ? std::min(dof[g], lines[i].dof) : lines[i].dof;
  }
  double sum = 0.0;
  for (std::size_t g = 0; g < lines.size(); ++g)
    if (dof[g] > 0.0) sum += variance[g] * variance[g] / dof[g];
  return sum;
}

}  // namespace

std::string_view name_of(Distribution distribution) {
  switch (distribution) {
    case Distribution::normal:
      return "normal";
    case Distribution::uniform:
      return "uniform";
    case Distribution::triangular:
      return "triangular";
    case Distribution::arcsine:
      return "arcsine";
    case Distribution::student_t:
      break;
  }
  return "Student t";
}

double std_of_half_width(double half_width, Distribution distribution) {
  switch (distribution) {
    case Distribution::uniform:
      return half_width / std::numbers::sqrt3;
    case Distribution::triangular:
      return half_width / std::sqrt(6.0);
    case Distribution::arcsine:
      return half_width / std::numbers::sqrt2;
    case Distribution::normal:
    case Distribution::student_t:
      break;
  }
  return half_width;
}

double coverage_factor(double level, double dof) {
  PM_EXPECTS(level > 0.0 && level < 1.0 && dof >= 0.0);
  constexpr double as_good_as_infinite = 1e6;
  const bool normal = dof == 0.0 || dof > as_good_as_infinite;
  const double whole = normal ? as_good_as_infinite : dof < 1.0 ? dof : std::floor(dof);
  if (normal) return std::sqrt(chi_square_quantile(level, 1.0));
  return student_t_quantile(0.5 + 0.5 * level, whole);
}

Result<UncertaintyBudget> combine(Measurand measurand,
                                  std::vector<BudgetLine> lines,
                                  const Eigen::MatrixXd& correlation) {
  if (const Status good = check(measurand, lines); !good) return good.error();
  if (const Status good = check_correlation(correlation, lines.size()); !good)
    return good.error().at(measurand.quantity);
  Eigen::VectorXd contributions(static_cast<Index>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i)
    contributions(static_cast<Index>(i)) = lines[i].contribution();
  const Eigen::VectorXd variances =
      correlation.size() == 0 ? Eigen::VectorXd(contributions.cwiseAbs2())
                              : Eigen::VectorXd(contributions.cwiseProduct(
                                    correlation.selfadjointView<Eigen::Lower>() * contributions));
  const double variance = std::max(variances.sum(), 0.0);

  UncertaintyBudget budget;
  budget.measurand = std::move(measurand);
  budget.lines = std::move(lines);
  for (const double part : variances)
    budget.shares.push_back(variance > 0.0 ? part / variance : 0.0);
  budget.combined_std = std::sqrt(variance);
  const double fourths =
      fourth_powers(budget.lines, variances, groups_of(budget.lines.size(), correlation));
  if (fourths > 0.0) budget.effective_dof = variance * variance / fourths;
  budget.coverage_factor_95 = coverage_factor(0.95, budget.effective_dof);
  budget.expanded_95 = budget.coverage_factor_95 * budget.combined_std;
  return budget;
}

}  // namespace proofmass::calibrate
