#include "proofmass/fit/nonlinear_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "proofmass/core/contract.hpp"
#include "proofmass/fit/minimum.hpp"
#include "proofmass/fit/objective.hpp"

namespace proofmass::fit {
namespace {

using Index = Eigen::Index;

constexpr double infinity = std::numeric_limits<double>::infinity();

Error invalid(const char* message) {
  return {Errc::invalid_argument, message};
}

std::optional<Error> bounds_error(const LeastSquaresProblem& problem) {
  const std::size_t p = problem.start.size();
  if ((!problem.lower.empty() && problem.lower.size() != p) ||
      (!problem.upper.empty() && problem.upper.size() != p))
    return invalid("give as many bounds as parameters, or none");
  for (std::size_t j = 0; j < p; ++j) {
    const double lower = problem.lower.empty() ? -infinity : problem.lower[j];
    const double upper = problem.upper.empty() ? infinity : problem.upper[j];
    if (!(lower <= upper)) return invalid("a lower bound lies above its upper bound");
    if (problem.start[j] < lower || problem.start[j] > upper)
      return invalid("the start lies outside its bounds");
  }
  return std::nullopt;
}

std::optional<Error> input_error(const LeastSquaresProblem& problem,
                                 const LeastSquaresOptions& options) {
  const std::size_t p = problem.start.size();
  if (p == 0) return invalid("no parameter to fit");
  if (options.max_iterations < 1) return invalid("max_iterations must be at least 1");
  if (!options.scale.empty() &&
      (options.scale.size() != p ||
       !std::ranges::all_of(options.scale, [](double s) { return std::isfinite(s) && s > 0.0; })))
    return invalid("give as many scales as parameters, positive ones, or none");
  if (!std::ranges::all_of(problem.start, [](double s) { return std::isfinite(s); }))
    return Error{Errc::not_finite, "the start has a NaN or infinite parameter"};
  if (auto error = bounds_error(problem)) return error;
  if (problem.residual_count < p)
    return Error{Errc::too_few_samples, std::to_string(problem.residual_count) +
                                            " residuals cannot determine " + std::to_string(p) +
                                            " parameters"};
  return std::nullopt;
}

LeastSquaresFit result_of(const Minimum& at, const Objective& objective, bool unit_variance) {
  const Index p = at.p.size();
  LeastSquaresFit fit{.parameters = {at.p.begin(), at.p.end()},
                      .covariance = Eigen::MatrixXd::Zero(p, p),
                      .std = std::vector<double>(static_cast<std::size_t>(p), 0.0),
                      .rss = at.rss,
                      .residual_std = std::numeric_limits<double>::quiet_NaN(),
                      .dof = static_cast<std::size_t>(
                          objective.residual_count() -
                          (objective.lower().array() < objective.upper().array()).count()),
                      .iterations = at.iterations,
                      .converged = at.converged,
                      .at_bound = std::vector<bool>(static_cast<std::size_t>(p), true),
                      .condition = at.tangent.condition};
  if (fit.dof > 0) fit.residual_std = std::sqrt(at.rss / static_cast<double>(fit.dof));
  const double variance = unit_variance ? 1.0 : fit.residual_std * fit.residual_std;
  for (std::size_t a = 0; a < at.free.size(); ++a) {
    const Index i = at.free[a];
    fit.at_bound[static_cast<std::size_t>(i)] = false;
    for (std::size_t b = 0; b < at.free.size(); ++b) {
      const double entry = at.tangent.inverse_product(static_cast<Index>(a), static_cast<Index>(b));
      // An undetermined parameter remains so when the variance is 0.
      fit.covariance(i, at.free[b]) = std::isinf(entry) ? entry : variance * entry;
    }
    fit.std[static_cast<std::size_t>(i)] = std::sqrt(fit.covariance(i, i));
  }
  return fit;
}

}  // namespace

Result<LeastSquaresFit> fit_least_squares(const LeastSquaresProblem& problem,
                                          const LeastSquaresOptions& options) {
  PM_EXPECTS(problem.residuals != nullptr);
  if (auto error = input_error(problem, options)) return *error;
  const Objective objective(problem, options);
  const Eigen::VectorXd start =
      Eigen::VectorXd::Map(problem.start.data(), static_cast<Index>(problem.start.size()));
  Eigen::VectorXd r;
  if (!objective.residuals(start, r))
    return Error{Errc::not_finite, "the residuals at the start are not finite"};
  return result_of(lowest_minimum(objective, start, options), objective, options.unit_variance);
}

}  // namespace proofmass::fit
