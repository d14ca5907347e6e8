#include "proofmass/fit/curve.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/contract.hpp"
#include "proofmass/fit/differences.hpp"

namespace proofmass::fit {
namespace {

bool all_finite(View<double> values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

// ∂f/∂p at one x.
Eigen::VectorXd gradient(double x, const CurveModel& model, std::vector<double> p) {
  Eigen::VectorXd g(static_cast<Eigen::Index>(p.size()));
  for (std::size_t j = 0; j < p.size(); ++j) {
    const double at = p[j];
    const auto along = [&](double t, Eigen::VectorXd& f) {
      p[j] = t;
      f.setConstant(1, model(x, p));
      return std::isfinite(f(0));
    };
    g(static_cast<Eigen::Index>(j)) =
        derivative(along, at, {.scale = at == 0.0 ? 1.0 : std::abs(at)}, 1)(0);
    p[j] = at;
  }
  return g;
}

// gᵀ C g; an infinite variance counts only if the curve depends on that parameter.
double quadratic_form(const Eigen::MatrixXd& C, const Eigen::VectorXd& g) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < g.size(); ++i)
    for (Eigen::Index j = 0; j < g.size(); ++j)
      if (g(i) != 0.0 && g(j) != 0.0) sum += g(i) * C(i, j) * g(j);
  return sum;
}

}  // namespace

Result<LeastSquaresFit> fit_curve(View<double> x,
                                  View<double> y,
                                  const CurveModel& model,
                                  View<double> start,
                                  const CurveOptions& options) {
  PM_EXPECTS(model != nullptr);
  const std::vector<double>& sigma = options.sigma;
  if (x.size() != y.size() || (!sigma.empty() && sigma.size() != y.size()))
    return Error{Errc::invalid_argument, "x, y and sigma differ in length"};
  if (!all_finite(x) || !all_finite(y))
    return Error{Errc::not_finite, "x or y has a NaN or infinite value"};
  if (!std::ranges::all_of(sigma, [](double s) { return std::isfinite(s) && s > 0.0; }))
    return Error{Errc::invalid_argument, "sigma must be positive and finite"};
  LeastSquaresProblem problem{.residuals = {},
                              .residual_count = y.size(),
                              .start = {start.begin(), start.end()},
                              .lower = options.lower,
                              .upper = options.upper};
  problem.residuals = [&](View<double> parameters, std::span<double> residuals) {
    for (std::size_t k = 0; k < y.size(); ++k)
      residuals[k] = (model(x[k], parameters) - y[k]) / (sigma.empty() ? 1.0 : sigma[k]);
  };
  return fit_least_squares(problem, options.solver);
}

std::vector<CurvePoint> curve_with_band(View<double> x,
                                        const CurveModel& model,
                                        const LeastSquaresFit& fit) {
  PM_EXPECTS(model != nullptr);
  std::vector<CurvePoint> curve;
  curve.reserve(x.size());
  for (const double at : x) {
    const Eigen::VectorXd g = gradient(at, model, fit.parameters);
    const double std = std::sqrt(std::max(0.0, quadratic_form(fit.covariance, g)));
    curve.push_back({model(at, fit.parameters), std, std::hypot(std, fit.residual_std)});
  }
  return curve;
}

}  // namespace proofmass::fit
