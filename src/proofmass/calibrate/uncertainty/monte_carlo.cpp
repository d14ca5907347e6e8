#include "proofmass/calibrate/uncertainty/monte_carlo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "proofmass/calibrate/uncertainty/correlation.hpp"
#include "proofmass/calibrate/uncertainty/draw.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;

constexpr double coverage = 0.95;

Interval shortest(const std::vector<double>& ascending) {
  const std::size_t n = ascending.size();
  const auto held = static_cast<std::size_t>(std::lround(coverage * static_cast<double>(n)));
  std::size_t best = 0;
  for (std::size_t k = 0; k + held < n; ++k)
    if (ascending[k + held] - ascending[k] < ascending[best + held] - ascending[best]) best = k;
  return {ascending[best], ascending[std::min(best + held, n - 1)]};
}

// Order statistics between which the true p-quantile lies with 95 % probability: binomial, in
// normal approximation.
Interval quantile_limits(const std::vector<double>& ascending, double p) {
  const auto n = static_cast<double>(ascending.size());
  const double reach = 1.96 * std::sqrt(n * p * (1.0 - p));
  const auto at = [&](double rank) {
    return ascending[static_cast<std::size_t>(std::clamp(std::round(rank), 0.0, n - 1.0))];
  };
  return {at(n * p - reach - 0.5), at(n * p + reach - 0.5)};
}

Status check_inputs(View<Input> inputs, const Eigen::MatrixXd& correlation) {
  for (const Input& input : inputs) {
    if (!std::isfinite(input.value) || !std::isfinite(input.std) || !std::isfinite(input.dof))
      return Error{Errc::not_finite, "an input is not a finite number"};
    if (input.std < 0.0 || input.dof < 0.0)
      return Error{Errc::invalid_argument,
                   "expected standard deviations and degrees of freedom of 0 or more"};
    if (correlation.size() > 0 && input.distribution != Distribution::normal)
      return Error{Errc::invalid_argument, "correlated inputs must be normal"};
  }
  return check_correlation(correlation, inputs.size());
}

// Fills one draw of all inputs; `root` is empty if they are independent.
void draw_inputs(View<Input> inputs,
                 const Eigen::MatrixXd& root,
                 Draw& draw,
                 Eigen::VectorXd& unit) {
  for (std::size_t i = 0; i < inputs.size(); ++i)
    unit(static_cast<Index>(i)) = draw(inputs[i].distribution, inputs[i].dof);
  if (root.size() > 0) unit = (root * unit).eval();
}

Agreement judged(double difference, double tolerance, double scatter) {
  if (difference + scatter <= tolerance) return Agreement::yes;
  return difference - scatter > tolerance ? Agreement::no : Agreement::cannot_tell;
}

std::string words(const GumValidation& found, const UncertaintyBudget& budget, std::size_t draws) {
  const double worst = std::max(found.lower_difference, found.upper_difference);
  const std::string ends = fmt::format(
      "the ends of the 95 % interval by the budget and by {} draws are at most {:.2g} {} "
      "apart, the tolerance is {:.2g} {}",
      draws, worst, budget.measurand.unit, found.tolerance, budget.measurand.unit);
  switch (found.agreement) {
    case Agreement::yes:
      return "Monte Carlo confirms the budget: " + ends + ".";
    case Agreement::no:
      return "Monte Carlo contradicts the budget, use its interval instead: " + ends + ".";
    case Agreement::cannot_tell:
      break;
  }
  return "The draws are too few to determine whether Monte Carlo confirms the budget: " + ends +
         ".";
}

}  // namespace

Result<Propagation> summary_of(std::vector<double> draws) {
  Propagation found;
  const std::size_t all = draws.size();
  std::erase_if(draws, [](double y) { return !std::isfinite(y); });
  found.draws = draws.size();
  found.without = all - draws.size();
  constexpr std::size_t fewest = 100;
  if (found.draws < fewest)
    return Error{Errc::too_few_samples,
                 fmt::format("{} of {} draws have a result: a 95 % interval needs {}", found.draws,
                             all, fewest)};
  std::ranges::sort(draws);
  const Moments spread = moments(draws);
  found.mean = spread.mean;
  found.std = spread.std();
  found.shortest_95 = shortest(draws);
  found.symmetric_95 = {*quantile(draws, 0.025), *quantile(draws, 0.975)};
  found.lower_end = quantile_limits(draws, 0.025);
  found.upper_end = quantile_limits(draws, 0.975);
  return found;
}

Result<Propagation> propagate(const Measurement& f,
                              View<Input> inputs,
                              const PropagateOptions& options) {
  if (const Status good = check_inputs(inputs, options.correlation); !good) return good.error();
  const Eigen::MatrixXd root =
      options.correlation.size() > 0 ? root_of(options.correlation) : Eigen::MatrixXd();
  Draw draw(options.seed);
  Eigen::VectorXd unit(static_cast<Index>(inputs.size()));
  std::vector<double> x(inputs.size()), y(options.draws);
  for (double& result : y) {
    draw_inputs(inputs, root, draw, unit);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = inputs[i].value + inputs[i].std * unit(static_cast<Index>(i));
    result = f(x);
  }
  return summary_of(std::move(y));
}

double numerical_tolerance(double std, int digits) {
  if (!(std > 0.0)) return 0.0;
  int exponent = static_cast<int>(std::floor(std::log10(std)));
  // 0.0996 has, to two digits, one decimal place less than its logarithm indicates.
  if (std::round(std / std::pow(10.0, exponent - digits + 1)) >= std::pow(10.0, digits)) ++exponent;
  return 0.5 * std::pow(10.0, exponent - digits + 1);
}

GumValidation validate(const UncertaintyBudget& budget, const Propagation& drawn, int digits) {
  PM_EXPECTS(digits == 1 || digits == 2);
  const double y = budget.measurand.value;
  GumValidation found;
  found.tolerance = numerical_tolerance(budget.combined_std, digits);
  found.lower_difference = std::abs(y - budget.expanded_95 - drawn.symmetric_95.lower);
  found.upper_difference = std::abs(y + budget.expanded_95 - drawn.symmetric_95.upper);
  const Agreement lower = judged(found.lower_difference, found.tolerance,
                                 0.5 * (drawn.lower_end.upper - drawn.lower_end.lower));
  const Agreement upper = judged(found.upper_difference, found.tolerance,
                                 0.5 * (drawn.upper_end.upper - drawn.upper_end.lower));
  found.agreement = lower == Agreement::no || upper == Agreement::no ? Agreement::no
                    : lower == Agreement::yes                        ? upper
                                                                     : Agreement::cannot_tell;
  found.verdict = words(found, budget, drawn.draws);
  return found;
}

}  // namespace proofmass::calibrate
