#include "proofmass/calibrate/multi_position_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <span>

#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/calibrate/multi_position_budget.hpp"
#include "proofmass/calibrate/uncertainty/adaptive_draws.hpp"
#include "proofmass/calibrate/uncertainty/draw.hpp"
#include "proofmass/calibrate/uncertainty/redrawn_fit.hpp"
#include "proofmass/calibrate/uncertainty/type_b_effect.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

Parameters type_b_errors(const std::vector<TypeBEffect>& effects, Draw& draw) {
  Parameters sum = Parameters::Zero();
  for (const TypeBEffect& effect : effects) {
    double error = 0.0;
    for (Index k = 0; k < 9; ++k) {
      const double own = draw(effect.line.distribution, effect.line.dof);
      error = effect.common && k > 0 ? error : own;
      sum(k) += effect.sensitivity(k) * effect.line.std * error;
    }
  }
  return sum;
}

// Student's t is wider than the standard uncertainty in the budget.
double expected_std(const UncertaintyBudget& budget) {
  double variance = 0.0;
  for (const BudgetLine& line : budget.lines) {
    const bool wider = !line.type_a && line.distribution == Distribution::student_t;
    const double factor = wider ? line.dof / (line.dof - 2.0) : 1.0;
    variance += factor * line.contribution() * line.contribution();
  }
  return variance > 0.0 ? std::sqrt(variance) : 0.0;
}

bool std_is_finite(const UncertaintyBudget& budget) {
  return std::ranges::none_of(budget.lines, [](const BudgetLine& line) {
    return !line.type_a && line.distribution == Distribution::student_t && line.dof <= 2.0;
  });
}

// Limits of the ratio of standard deviations, and of the coverage, for this number of draws of a
// correct budget: each test is made at 1 % over all parameters together. With many draws it would
// find the budget's own approximations; what does not change its second digit is tolerated.
struct Limits {
  double lowest_ratio, highest_ratio, least_inside;
};

Limits limits_of(std::size_t draws, std::size_t parameters) {
  const auto n = static_cast<double>(draws);
  const double level = 0.01 / (2.0 * static_cast<double>(parameters));
  const double z = std::sqrt(chi_square_quantile(1.0 - 2.0 * level, 1.0));
  return {std::min(0.95, std::sqrt(chi_square_quantile(0.5 * level, n - 1.0) / (n - 1.0))),
          std::max(1.05, std::sqrt(chi_square_quantile(1.0 - 0.5 * level, n - 1.0) / (n - 1.0))),
          0.95 - std::max(0.01, z * std::sqrt(0.95 * 0.05 / n))};
}

// A standard deviation at rounding level counts as zero.
double rounding_of(const MultiPosition& fit, std::size_t k) {
  constexpr double part = 1e-9;
  if (k >= 6) return part;
  const double scale = std::abs(fit.estimate[3 + k % 3]);
  return part * (k < 3 ? scale * fit.gravity_mps2 : scale);
}

ParameterCheck compared(const UncertaintyBudget& budget,
                        const std::vector<double>& draws,
                        const Limits& limits,
                        double rounding) {
  const double y = budget.measurand.value;
  const Propagation found = summary_of(draws).value();
  ParameterCheck check;
  check.quantity = budget.measurand.quantity;
  check.unit = budget.measurand.unit;
  check.budget_std = budget.combined_std;
  check.drawn_std = found.std;
  check.drawn_95 = found.symmetric_95;
  const double reach = budget.expanded_95 + rounding;
  const auto inside =
      std::ranges::count_if(draws, [&](double draw) { return std::abs(draw - y) <= reach; });
  check.inside = static_cast<double>(inside) / static_cast<double>(found.draws);
  if (budget.combined_std <= rounding) {
    check.agreement = found.std <= 10.0 * rounding ? BudgetSize::right : BudgetSize::too_small;
    return check;
  }
  check.drawn_shift = (found.mean - y) / budget.combined_std;
  const double ratio = std_is_finite(budget) ? found.std / expected_std(budget) : 1.0;
  if (ratio > limits.highest_ratio || check.inside < limits.least_inside)
    check.agreement = BudgetSize::too_small;
  else if (ratio < limits.lowest_ratio)
    check.agreement = BudgetSize::too_large;
  return check;
}

std::string listed(const std::vector<ParameterCheck>& parameters, BudgetSize size) {
  std::string names;
  for (const ParameterCheck& one : parameters)
    if (one.agreement == size) names += (names.empty() ? "" : ", ") + one.quantity;
  return names;
}

std::string counts_of(const std::vector<ParameterCheck>& parameters) {
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0, least = 1.0, most = 0.0;
  for (const ParameterCheck& one : parameters) {
    least = std::min(least, one.inside);
    most = std::max(most, one.inside);
    if (!(one.budget_std > 0.0)) continue;
    lowest = std::min(lowest, one.drawn_std / one.budget_std);
    highest = std::max(highest, one.drawn_std / one.budget_std);
  }
  if (highest == 0.0) return "there is no uncertainty to compare";
  return fmt::format(
      "the standard deviations are {:.2f} to {:.2f} times the budget's, and its 95 % intervals "
      "hold "
      "{:.0f} to {:.0f} % of the draws",
      lowest, highest, 100.0 * least, 100.0 * most);
}

std::string verdict_of(const MonteCarloCheck& check) {
  const std::string small = listed(check.parameters, BudgetSize::too_small);
  const std::string large = listed(check.parameters, BudgetSize::too_large);
  const std::string beside =
      large.empty() ? std::string() : fmt::format(" It is larger than needed for {}.", large);
  const std::string failed = check.failed == 0
                                 ? std::string()
                                 : fmt::format(" {} of {} drawn sets could not be calibrated.",
                                               check.failed, check.failed + check.draws);
  const std::string procedure =
      !check.stable   ? ""
      : *check.stable ? " (JCGM 101's adaptive procedure, two digits of each uncertainty stable)"
                      : " (JCGM 101's adaptive procedure, ended before two digits were stable)";
  return fmt::format("{} calibrations of simulated data{} {}: {}.{}{}", check.draws, procedure,
                     small.empty()
                         ? std::string("confirm the budget")
                         : fmt::format("contradict the budget of {}, which is too small", small),
                     counts_of(check.parameters), beside, failed);
}

std::size_t place_of(const std::string& quantity) {
  const auto& names = parameter_names();
  return static_cast<std::size_t>(std::ranges::find(names, quantity) - names.begin());
}

// The calibration of a drawn set of poses, gravity and type B errors; NaN if it has none.
class Redraw {
 public:
  Redraw(View<Pose> poses,
         const MultiPositionOptions& options,
         const MultiPosition& fit,
         const std::vector<TypeBEffect>& effects)
      : from_(drawn_from(poses, options, fit)),
        options_(options),
        fit_(fit),
        effects_(effects),
        calibrate_(from_, options, fit) {}

  void fill(std::size_t draws, std::uint64_t seed, std::span<std::vector<double>> columns) const {
    Draw draw(seed);
    for (std::size_t k = 0; k < draws; ++k) {
      const double gravity = options_.gravity_mps2 + options_.gravity_std_mps2 * draw.normal();
      const std::vector<Pose> drawn = redrawn(from_, fit_, draw);
      const Parameters errors = type_b_errors(effects_, draw);
      const std::optional<Parameters> one = calibrate_(drawn, gravity);
      for (std::size_t j = 0; j < columns.size(); ++j) {
        const auto place = static_cast<Index>(j);
        columns[j].push_back(one ? (*one)(place) + errors(place) : no_value);
      }
    }
  }

 private:
  DrawnFrom from_;
  const MultiPositionOptions& options_;
  const MultiPosition& fit_;
  const std::vector<TypeBEffect>& effects_;
  RedrawnFit calibrate_;
};

// A column of draws for each parameter.
AdaptiveDraws calibrated_draws(const Redraw& redraw, const MonteCarloOptions& how) {
  if (how.draws) {
    AdaptiveDraws out{std::vector<std::vector<double>>(9), false};
    redraw.fill(*how.draws, how.seed, out.columns);
    return out;
  }
  AdaptiveOptions options;
  options.progress = how.progress;
  return draw_until_stable(
      9,
      [&](std::size_t batch, std::span<std::vector<double>> columns) {
        redraw.fill(options.batch, how.seed + batch, columns);
      },
      options);
}

}  // namespace

Result<MonteCarloCheck> check_by_monte_carlo(View<Pose> poses,
                                             const MultiPositionOptions& options,
                                             const MultiPosition& fit,
                                             const MonteCarloOptions& how) {
  PM_EXPECTS(fit.poses.size() == poses.size());
  if (!fit.doubtful.empty())
    return Error{
        Errc::not_observable,
        "one of several positions is bad, and which one is undetermined: there is no unique fit to "
        "draw from"};
  const auto budgets = budget_of(fit, how.lines, how.reading_unit);
  if (!budgets) return budgets.error();
  const auto effects = effects_of(fit, how.lines, how.reading_unit);
  const auto [columns, stable] = calibrated_draws(Redraw(poses, options, fit, *effects), how);
  const Result<Propagation> first = summary_of(columns[0]);
  if (!first) return first.error().at("Monte Carlo check");
  MonteCarloCheck check;
  if (!how.draws) check.stable = stable;
  check.draws = first->draws;
  check.failed = first->without;
  const Limits limits = limits_of(check.draws, budgets->size());
  for (const UncertaintyBudget& budget : *budgets) {
    const std::size_t k = place_of(budget.measurand.quantity);
    check.parameters.push_back(compared(budget, columns[k], limits, rounding_of(fit, k)));
    check.agrees &= check.parameters.back().agreement != BudgetSize::too_small;
  }
  check.verdict = verdict_of(check);
  return check;
}

}  // namespace proofmass::calibrate
