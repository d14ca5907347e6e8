#include "proofmass/characterise/temperature_model.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/characterise/temperature/blocks.hpp"
#include "proofmass/characterise/temperature/regression.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t fewest_blocks = 32;
constexpr int most_degree_allowed = 8;
constexpr double normal_95 = 1.644854;

void set_coefficients(TemperatureModel& model, const TemperatureCurve& curve, Index level) {
  const Index count = model.degree + 1;
  model.basis_coefficients = curve.values.segment(level, count);
  model.basis_covariance = curve.covariance.block(level, level, count, count);
  MatrixXd powers = MatrixXd::Zero(count, count);  // of (T − reference)/scale in each polynomial
  powers(0, 0) = 1.0;
  for (Index j = 0; j + 1 < count; ++j) {
    const auto k = static_cast<std::size_t>(j);
    powers.col(j + 1).tail(count - 1) = powers.col(j).head(count - 1);
    powers.col(j + 1) -= model.basis.alpha[k] * powers.col(j);
    if (j > 0) powers.col(j + 1) -= model.basis.beta[k] * powers.col(j - 1);
  }
  for (Index j = 0; j < count; ++j)
    powers.row(j) /= std::pow(model.basis.scale_k, static_cast<double>(j));
  const VectorXd values = powers * model.basis_coefficients;
  model.covariance = powers * model.basis_covariance * powers.transpose();
  for (Index j = 0; j < count; ++j)
    model.coefficients.push_back({values(j), std::sqrt(model.covariance(j, j))});
}

double span_of(const TemperatureModel& model) {
  constexpr int steps = 400;
  double least = 0.0, most = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double T = model.lowest_k + (model.highest_k - model.lowest_k) * k / steps;
    const double y = model.basis.at(T).head(model.degree + 1).dot(model.basis_coefficients);
    least = k == 0 ? y : std::min(least, y);
    most = k == 0 ? y : std::max(most, y);
  }
  return most - least;
}

void set_noise(TemperatureModel& model,
               const TemperatureProblem& problem,
               const TemperatureCurve& curve) {
  const VectorXd residuals =
      problem.columns.rightCols(1) - problem.columns.leftCols(curve.values.size()) * curve.values;
  model.residual_std = std::sqrt(residuals.squaredNorm() /
                                 static_cast<double>(residuals.size() - curve.values.size()));
  model.white_std = std::sqrt(problem.noise.white_variance);
  model.drift_std =
      std::sqrt(std::max(0.0, problem.drift.diagonal().mean() - problem.drift.mean()));
}

void set_hysteresis(TemperatureModel& model, const TemperatureCurve& curve) {
  model.hysteresis = Uncertain{curve.values(0), std::sqrt(curve.covariance(0, 0))};
  model.hysteresis_significant =
      std::abs(model.hysteresis->value) > normal_975 * model.hysteresis->std;
}

void add_notes(TemperatureModel& model, const TemperatureBlocks& of) {
  const double least = std::min(of.risen_k, of.fallen_k), most = std::max(of.risen_k, of.fallen_k);
  if (least < 0.1 * of.span_k() && most > 0.0) {
    const bool rose = of.risen_k > of.fallen_k;
    model.notes.push_back(
        fmt::format("the temperature only {}: a drift in time would look the same; record a {} as "
                    "well",
                    rose ? "rose" : "fell", rose ? "cooling" : "heating"));
  }
  if (of.widest_gap_k > 0.25 * of.span_k()) {
    model.notes.push_back(
        fmt::format("nothing was recorded between {:.1f} and {:.1f} K: there the curve is a guess",
                    of.gap_from_k, of.gap_from_k + of.widest_gap_k));
  }
}

void set_verdict(TemperatureModel& model, bool wide_enough, double least_span_k) {
  if (!wide_enough) {
    model.reason = fmt::format("the temperature spans {:.3g} K; a curve needs {:.3g} K",
                               model.highest_k - model.lowest_k, least_span_k);
  } else if (model.degree == 0) {
    model.reason = fmt::format(
        "the bias does not follow temperature beyond its scatter: below {:.3g} per kelvin (95 %)",
        *model.slope_upper_95);
  } else {
    model.verdict = Verdict::identified;
  }
}

Status check(const TemperatureOptions& options) {
  if (!std::isfinite(options.rate_hz) || options.rate_hz <= 0.0)
    return Error{Errc::invalid_argument, "rate_hz must be positive and finite"};
  if (!std::isfinite(options.least_span_k) || options.least_span_k < 0.0)
    return Error{Errc::invalid_argument, "least_span_k must be finite and not negative"};
  if (options.most_degree < 1 || options.most_degree > most_degree_allowed)
    return Error{Errc::invalid_argument, "most_degree must be 1 to 8"};
  return Done{};
}

}  // namespace

Eigen::VectorXd OrthogonalPolynomials::at(double temperature_k) const {
  const double x = (temperature_k - reference_k) / scale_k;
  VectorXd p = VectorXd::Ones(static_cast<Index>(alpha.size()) + 1);
  for (std::size_t j = 0; j < alpha.size(); ++j) {
    const auto k = static_cast<Index>(j);
    p(k + 1) = (x - alpha[j]) * p(k) - (j > 0 ? beta[j] * p(k - 1) : 0.0);
  }
  return p;
}

Result<Uncertain> TemperatureModel::at(double temperature_k) const {
  if (std::isnan(temperature_k) || temperature_k < lowest_k || temperature_k > highest_k) {
    return Error{Errc::invalid_argument,
                 fmt::format("{:.2f} K is outside the temperatures recorded, {:.2f} to {:.2f} K",
                             temperature_k, lowest_k, highest_k)};
  }
  const VectorXd p = basis.at(temperature_k).head(degree + 1);
  return Uncertain{p.dot(basis_coefficients), std::sqrt(p.dot(basis_covariance * p))};
}

Result<TemperatureModel> fit_temperature(View<double> series,
                                         View<double> temperature_k,
                                         const TemperatureOptions& options) {
  PM_EXPECTS(series.size() == temperature_k.size());
  if (const Status options_make_sense = check(options); !options_make_sense)
    return options_make_sense.error();
  const TemperatureBlocks of = temperature_blocks(series, temperature_k, options.rate_hz);
  if (of.blocks.size() < fewest_blocks) {
    return Error{Errc::too_few_samples,
                 "fewer than 32 stretches of 8 samples have both the series and its temperature"};
  }
  TemperatureModel model;
  model.block_s = of.block_s;
  model.lowest_k = of.lowest_k;
  model.highest_k = of.highest_k;
  const double rounding = 1e-9 * std::max(std::abs(of.lowest_k), std::abs(of.highest_k));
  const bool wide_enough = of.span_k() >= options.least_span_k && of.span_k() > rounding;
  const int most_degree = wide_enough ? std::min(options.most_degree, of.occupied - 1) : 0;
  model.basis = orthogonal_polynomials(of, most_degree);
  model.reference_k = model.basis.reference_k;
  model.points = temperature_points(of);

  const TemperatureProblem problem =
      temperature_problem(of, block_means(model.basis, of, series, temperature_k));
  model.cross_validation = cross_validate(problem);
  model.degree = chosen_degree(problem, model.cross_validation);
  const TemperatureCurve curve = fit_curve(problem, model.degree);
  set_coefficients(model, curve, problem.level);
  set_noise(model, problem, curve);
  if (wide_enough) {
    const TemperatureCurve line = fit_curve(problem, 1);
    const double std = std::sqrt(line.covariance(problem.level + 1, problem.level + 1));
    model.slope_upper_95 =
        (std::abs(line.values(problem.level + 1)) + normal_95 * std) / model.basis.scale_k;
    model.bias_span = span_of(model);
    if (problem.level > 0) set_hysteresis(model, curve);
    add_notes(model, of);
  }
  set_verdict(model, wide_enough, options.least_span_k);
  return model;
}

}  // namespace proofmass::characterise
