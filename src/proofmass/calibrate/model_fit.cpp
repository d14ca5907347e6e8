#include "proofmass/calibrate/model_fit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/calibrate/model_equation/confounded_words.hpp"
#include "proofmass/calibrate/model_equation/identifiability.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/number_words.hpp"
#include "proofmass/fit/variable_projection.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Index;
using sensor::Coefficient;
using sensor::ModelEquation;

std::size_t size_of(Index n) {
  return static_cast<std::size_t>(n);
}

bool finite(const ModelRow& row) {
  const sensor::Motion& m = row.motion;
  const double all[] = {m.ai_mps2,       m.ap_mps2,       m.ao_mps2,
                        m.omega_i_radps, m.omega_p_radps, m.omega_dot_o_radps2,
                        row.output,      row.output_std};
  return std::ranges::all_of(all, [](double x) { return std::isfinite(x); });
}

Status check(View<ModelRow> rows, const ModelFitOptions& options) {
  if (options.fitted.empty()) return Error{Errc::invalid_argument, "no coefficient to fit"};
  for (auto one = options.fitted.begin(); one != options.fitted.end(); ++one) {
    if (std::find(options.fitted.begin(), one, *one) != one) {
      return Error{Errc::invalid_argument,
                   fmt::format("{} is requested twice", sensor::info(*one).name)};
    }
  }
  std::size_t stated = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!finite(rows[k])) {
      return Error{Errc::not_finite, fmt::format("row {} is not finite", k + 1)};
    }
    if (rows[k].output_std < 0.0) {
      return Error{Errc::invalid_argument,
                   fmt::format("row {}: its standard deviation is below zero", k + 1)};
    }
    if (rows[k].output_std > 0.0) ++stated;
  }
  if (stated != 0 && stated != rows.size()) {
    return Error{Errc::invalid_argument,
                 fmt::format("{} of {} rows state a standard deviation above zero: all of them or "
                             "none must",
                             stated, rows.size())};
  }
  return Done{};
}

// y ≈ X β, both over the rows' standard deviations if they are stated.
struct Linear {
  Eigen::MatrixXd X;
  Eigen::VectorXd y;
  Eigen::VectorXd sigma;  ///< 1 if not stated
  std::optional<Index> k1;
  double scale = 1.0;  ///< coefficients are β over this where K1 is not fitted
};

// K1's bracket for the held coefficients, times K1 if that is held too.
ModelEquation held_part(const ModelFitOptions& options) {
  ModelEquation held = options.held;
  for (const Coefficient which : options.fitted) {
    held.*sensor::info(which).member = which == Coefficient::K1 ? 1.0 : 0.0;
  }
  return held;
}

Linear linear_problem(View<ModelRow> rows, const ModelFitOptions& options) {
  Linear problem;
  const auto n = static_cast<Index>(rows.size()), p = std::ssize(options.fitted);
  const ModelEquation held = held_part(options);
  const auto k1 = std::ranges::find(options.fitted, Coefficient::K1);
  if (k1 != options.fitted.end()) problem.k1 = k1 - options.fitted.begin();
  problem.X.resize(n, p);
  problem.y.resize(n);
  problem.sigma.resize(n);
  for (Index r = 0; r < n; ++r) {
    const ModelRow& row = rows[size_of(r)];
    const double sigma = row.output_std > 0.0 ? row.output_std : 1.0;
    const double by_held = sensor::output(held, row.motion);
    for (Index c = 0; c < p; ++c) {
      problem.X(r, c) = sensor::term(options.fitted[size_of(c)], row.motion) / sigma;
    }
    if (problem.k1) problem.X(r, *problem.k1) = by_held / sigma;
    problem.y(r) = (row.output - (problem.k1 ? 0.0 : by_held)) / sigma;
    problem.sigma(r) = sigma;
  }
  if (!problem.k1) problem.scale = held.K1;
  return problem;
}

// The columns that remain without those that the rows do not determine.
std::vector<Index> determined_columns(const Identifiability& found) {
  std::vector<Index> columns;
  for (std::size_t c = 0; c < found.excited.size(); ++c) {
    const bool left_out = std::ranges::any_of(found.tied, [&](const TiedTerms& group) {
      return std::ranges::find(group.left_out, c) != group.left_out.end();
    });
    if (found.excited[c] && !left_out) columns.push_back(static_cast<Index>(c));
  }
  return columns;
}

// β and its covariance, without values for the omitted columns.
struct Solution {
  Eigen::VectorXd beta;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd inflation;
  Eigen::VectorXd residuals;  ///< over sigma
  Eigen::VectorXd leverage;   ///< of each row on its own fit
};

Solution solve(const Linear& problem, const std::vector<Index>& columns) {
  const Index p = problem.X.cols(), rank = std::ssize(columns);
  Eigen::MatrixXd X(problem.X.rows(), rank);
  for (Index k = 0; k < rank; ++k) X.col(k) = problem.X.col(columns[size_of(k)]);
  const auto factored = fit::factor_columns(X);
  const Eigen::VectorXd beta = factored->R_inverse * (factored->Q.transpose() * problem.y);
  Solution solution{Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p), Eigen::VectorXd::Zero(p),
                    problem.y - X * beta, factored->Q.rowwise().squaredNorm()};
  for (Index a = 0; a < rank; ++a) {
    const Index at = columns[size_of(a)];
    solution.beta(at) = beta(a);
    solution.inflation(at) =
        factored->inverse_product(a, a) * factored->length(a) * factored->length(a);
    for (Index b = 0; b < rank; ++b) {
      solution.covariance(at, columns[size_of(b)]) = factored->inverse_product(a, b);
    }
  }
  return solution;
}

// From β = K1 c to c and its covariance.
void divide_by_k1(const Linear& problem, Solution& solution) {
  const Index p = solution.beta.size();
  Eigen::MatrixXd J = Eigen::MatrixXd::Identity(p, p) / problem.scale;
  Eigen::VectorXd c = solution.beta / problem.scale;
  if (problem.k1) {
    const Index at = *problem.k1;
    const double k1 = solution.beta(at);
    c = solution.beta / k1;
    J = Eigen::MatrixXd::Identity(p, p) / k1;
    J.col(at) -= c / k1;
    J.row(at).setZero();
    J(at, at) = 1.0;
    c(at) = k1;
  }
  solution.covariance = J * solution.covariance * J.transpose();
  solution.beta = c;
}

void judge_residuals(const Linear& problem, const Solution& solution, ModelFit& fit) {
  const double chi_square = solution.residuals.squaredNorm();
  const Eigen::VectorXd residuals = solution.residuals.cwiseProduct(problem.sigma);
  fit.residuals.assign(residuals.begin(), residuals.end());
  fit.residual_rms = residuals.norm() / std::sqrt(static_cast<double>(residuals.size()));
  if (fit.dof == 0) return;
  const auto dof = static_cast<double>(fit.dof);
  if (!fit.std_stated) {
    fit.scatter = std::sqrt(chi_square / dof);
    return;
  }
  fit.test = ResidualTest{chi_square, chi_square_p(chi_square, dof)};
  constexpr double beyond_chance = 0.01;
  if (fit.test->p >= beyond_chance) return;
  fit.scatter = std::sqrt(chi_square / dof);
  fit.notes.push_back(
      fmt::format("the residuals are {:.3g} times what the stated standard deviations explain "
                  "(p = {:.2g}): a term is missing, the motion is wrong, or the outputs are "
                  "noisier than stated; standard deviations were increased by that factor",
                  fit.scatter, fit.test->p));
}

// p-value of a row's deviation from a fit to the others; 1 if it alone determines a term, or if the
// others do not agree with each other.
double deletion_p(const Solution& solution, Index row, const ModelFit& fit) {
  constexpr double least_own = 1e-9, others_fit = 0.01;
  const double own = 1.0 - solution.leverage(row), left = static_cast<double>(fit.dof) - 1.0;
  if (own < least_own || left < 1.0) return 1.0;
  const double square = solution.residuals(row) * solution.residuals(row) / own;
  const double others = solution.residuals.squaredNorm() - square;
  if (fit.std_stated && chi_square_p(std::max(others, 0.0), left) > others_fit)
    return chi_square_p(square, 1.0);
  if (!(others > 0.0)) return 1.0;
  return student_t_p(std::sqrt(square * left / others), left);
}

void name_wrong_rows(const Solution& solution, ModelFit& fit) {
  constexpr double chance = 0.01;
  const double least = chance / static_cast<double>(solution.residuals.size());
  for (Index row = 0; row < solution.residuals.size(); ++row) {
    if (deletion_p(solution, row, fit) >= least) continue;
    fit.suspects.push_back(size_of(row));
    fit.notes.push_back(
        fmt::format("row {} contradicts the others (residual {:.3g}): check its output and its "
                    "motion; it remains in the fit",
                    row + 1, fit.residuals[size_of(row)]));
  }
}

void note_near_confounding(const std::vector<Index>& columns,
                           const Solution& solution,
                           ModelFit& fit) {
  constexpr double much = 100.0;
  for (const Index c : columns) {
    const double inflation = solution.inflation(c);
    if (!(inflation > much)) continue;
    Index partner = c;
    double strongest = -1.0;
    for (const Index other : columns) {
      const double r =
          std::abs(solution.covariance(c, other)) / std::sqrt(solution.covariance(other, other));
      if (other != c && r > strongest) {
        strongest = r;
        partner = other;
      }
    }
    fit.notes.push_back(fmt::format(
        "{} is nearly confounded, most with {}: its variance is {:.3g} times what it would be if "
        "the others were known",
        sensor::info(fit.coefficients[size_of(c)].coefficient).name,
        sensor::info(fit.coefficients[size_of(partner)].coefficient).name, inflation));
  }
}

Status k1_is_determined(const Linear& problem,
                        const Identifiability& found,
                        const Solution& solution,
                        const ModelFit& fit) {
  if (!problem.k1) return Done{};
  const Index at = *problem.k1;
  if (!found.excited[size_of(at)]) {
    return Error{Errc::not_observable,
                 "K1 cannot be determined: no row has acceleration along the input axis; add such "
                 "rows, or leave K1 out and state it"};
  }
  constexpr double chance = 1e-3;
  const double k1 = solution.beta(at), std = std::sqrt(solution.covariance(at, at));
  const double t = std::abs(k1) / std;
  if (std == 0.0 || student_t_p(t, fit.std_stated ? 1e9 : static_cast<double>(fit.dof)) < chance) {
    return Done{};
  }
  return Error{
      Errc::not_observable,
      fmt::format("K1 = {} with standard deviation {} cannot be distinguished from zero, and all "
                  "other coefficients are relative to it",
                  compact(k1, 3), compact(std, 3))};
}

void fill_coefficients(const Linear& problem,
                       const Identifiability& found,
                       const Solution& solution,
                       ModelFit& fit) {
  const bool by_residuals = !fit.std_stated || fit.scatter != 1.0;
  const double coverage_95 =
      by_residuals ? student_t_quantile(0.975, static_cast<double>(fit.dof)) : 1.959964;
  for (std::size_t c = 0; c < fit.coefficients.size(); ++c) {
    FittedCoefficient& one = fit.coefficients[c];
    const auto at = static_cast<Index>(c);
    if (!found.excited[c]) {
      one.reason = fmt::format("{}: {}", sensor::info(one.coefficient).name,
                               unexcited_words(one.coefficient));
      continue;
    }
    const auto group = std::ranges::find_if(found.tied, [&](const TiedTerms& tied) {
      return std::ranges::find(tied.left_out, c) != tied.left_out.end() ||
             std::ranges::find(tied.retained, c) != tied.retained.end();
    });
    const double value = solution.beta(at);
    if (group != found.tied.end()) {
      one.reason = fit.confounded[size_of(group - found.tied.begin())].words;
      // Its combination replaces K1, by which all others were divided.
      if (problem.k1 == at) fit.equation.K1 = value;
      continue;
    }
    one.value = Uncertain{value, std::sqrt(solution.covariance(at, at))};
    one.half_width_95 = coverage_95 * one.value->std;
    one.variance_inflation = solution.inflation(at);
    fit.equation.*sensor::info(one.coefficient).member = value;
  }
  fit.covariance = solution.covariance;
  for (std::size_t c = 0; c < fit.coefficients.size(); ++c) {
    if (fit.coefficients[c].value) continue;
    fit.covariance.row(static_cast<Index>(c)).setZero();
    fit.covariance.col(static_cast<Index>(c)).setZero();
  }
}

Status enough_rows(const Linear& problem, std::size_t rank, bool std_stated) {
  if (rank == 0 && problem.X.rows() > 0) {
    return Error{Errc::not_observable,
                 "no row has a motion that any of these coefficients would answer to"};
  }
  const auto rows = size_of(problem.X.rows());
  if (rows < rank || rows < 2) {
    return Error{Errc::too_few_samples,
                 fmt::format("{} rows for {} coefficients", rows, problem.X.cols())};
  }
  if (rows > rank || std_stated) return Done{};
  return Error{Errc::too_few_samples,
               fmt::format("{} rows for {} coefficients leave no redundancy: state the "
                           "standard deviation of the outputs, add rows or omit a coefficient",
                           rows, rank)};
}

}  // namespace

const FittedCoefficient* ModelFit::find(Coefficient coefficient) const {
  const auto found = std::ranges::find(coefficients, coefficient, &FittedCoefficient::coefficient);
  return found == coefficients.end() ? nullptr : &*found;
}

Result<ModelFit> fit_model_equation(View<ModelRow> rows, const ModelFitOptions& options) {
  if (const Status status = check(rows, options); !status) return status.error();
  const Linear problem = linear_problem(rows, options);
  if (!(std::abs(problem.scale) > 0.0)) {
    return Error{Errc::invalid_argument, "K1 is held at zero"};
  }
  if (!problem.X.allFinite()) {
    return Error{Errc::not_finite, "accelerations so large that their products are not finite"};
  }
  const double unit_length = problem.sigma.cwiseInverse().norm();
  const Identifiability found = identifiability(problem.X, options.fitted, unit_length);
  const std::vector<Index> columns = determined_columns(found);
  ModelFit fit;
  fit.equation = options.held;
  fit.std_stated = !rows.empty() && rows.front().output_std > 0.0;
  if (const Status status = enough_rows(problem, columns.size(), fit.std_stated); !status) {
    return status.error();
  }
  for (const Coefficient one : options.fitted) fit.coefficients.push_back({.coefficient = one});
  fit.dof = rows.size() - columns.size();
  fit.condition = found.condition;
  Solution solution = solve(problem, columns);
  judge_residuals(problem, solution, fit);
  name_wrong_rows(solution, fit);
  solution.covariance *= fit.scatter * fit.scatter;
  if (const Status status = k1_is_determined(problem, found, solution, fit); !status)
    return status.error();
  note_near_confounding(columns, solution, fit);
  divide_by_k1(problem, solution);
  for (const TiedTerms& group : found.tied) {
    fit.confounded.push_back(
        describe_confounded(group, options.fitted, {solution.beta, solution.covariance}));
  }
  fill_coefficients(problem, found, solution, fit);
  return fit;
}

}  // namespace proofmass::calibrate
