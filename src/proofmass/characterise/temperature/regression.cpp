#include "proofmass/characterise/temperature/regression.hpp"

#include <cmath>
#include <cstddef>

#include "proofmass/core/linalg.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index folds = 8, segments = 32;

double sign_of(Sweep sweep) {
  return sweep == Sweep::dwell ? 0.0 : sweep == Sweep::heating ? 1.0 : -1.0;
}

VectorXd solved(const MatrixXd& normal, Index causes) {
  return positive_inverse(normal.topLeftCorner(causes, causes)) *
         normal.col(normal.cols() - 1).head(causes);
}

// The rows of each fold: contiguous intervals of equal weight, assigned in turn.
std::vector<std::vector<Index>> rows_of_folds(const VectorXd& crowds) {
  std::vector<std::vector<Index>> rows(folds);
  const double total = crowds.cwiseInverse().sum();
  double before = 0.0;
  for (Index row = 0; row < crowds.size(); ++row) {
    const double middle = before + 0.5 / crowds(row);
    before += 1.0 / crowds(row);
    const auto segment = static_cast<Index>(middle / total * static_cast<double>(segments));
    rows[static_cast<std::size_t>(segment % folds)].push_back(row);
  }
  return rows;
}

// Mean square prediction error of each fold's blocks from all others, by fold and degree. With P =
// V⁻¹ and residuals r from a curve, the prediction error of a fold f given the others is P_ff⁻¹ (P
// r)_f, of covariance P_ff⁻¹; and without f, XᵀPX is less by (PX)_fᵀ P_ff⁻¹ (PX)_f.
MatrixXd fold_scores(const TemperatureProblem& problem) {
  const MatrixXd PX = problem.inverse * problem.columns;
  const MatrixXd all = problem.columns.transpose() * PX;
  MatrixXd scores = MatrixXd::Zero(folds, problem.most_degree + 1);
  Index fold = 0;
  for (const std::vector<Index>& rows : rows_of_folds(problem.crowds)) {
    if (rows.empty()) continue;
    const MatrixXd PX_f = PX(rows, Eigen::all);
    const MatrixXd in = PX_f.transpose() * positive_inverse(problem.inverse(rows, rows)) * PX_f;
    const MatrixXd others = all - in;
    for (int degree = 0; degree <= problem.most_degree; ++degree) {
      const Index causes = problem.causes(degree);
      VectorXd r = VectorXd::Zero(all.cols());
      r.head(causes) = -solved(others, causes);
      r(all.cols() - 1) = 1.0;
      scores(fold, degree) = r.dot(in * r) / static_cast<double>(rows.size());
    }
    ++fold;
  }
  return scores;
}

}  // namespace

TemperatureProblem temperature_problem(const TemperatureBlocks& of, const MatrixXd& polynomials) {
  TemperatureProblem problem;
  problem.level = of.both_ways ? 1 : 0;
  problem.most_degree = static_cast<int>(polynomials.cols()) - 1;
  const auto n = static_cast<Index>(of.blocks.size());
  problem.columns.resize(n, problem.level + polynomials.cols() + 1);
  problem.columns.middleCols(problem.level, polynomials.cols()) = polynomials;
  problem.crowds.resize(n);
  std::vector<double> places;
  for (Index row = 0; row < n; ++row) {
    const TemperatureBlock& block = of.blocks[static_cast<std::size_t>(row)];
    if (of.both_ways) problem.columns(row, 0) = 0.5 * sign_of(block.sweep);
    problem.columns(row, problem.columns.cols() - 1) = block.mean;
    problem.crowds(row) = block.crowd;
    places.push_back(block.place);
  }
  problem.noise = likely_noise(problem.columns, places);
  problem.drift = drift_covariance(problem.noise, places);
  MatrixXd V = problem.drift;
  V.diagonal() += problem.noise.white_variance * problem.crowds;
  problem.inverse = positive_inverse(V);
  return problem;
}

TemperatureCurve fit_curve(const TemperatureProblem& problem, int degree) {
  const MatrixXd X = problem.columns.leftCols(problem.causes(degree));
  const MatrixXd XP = X.transpose() * problem.inverse;
  MatrixXd A = positive_inverse(XP * X) * XP;
  TemperatureCurve curve;
  curve.values = A * problem.columns.rightCols(1);
  curve.covariance = problem.noise.white_variance * A * A.transpose();
  // The level is that of the recording: its drift is about its own mean.
  A.row(problem.level).array() -= 1.0 / static_cast<double>(X.rows());
  curve.covariance += A * problem.drift * A.transpose();
  return curve;
}

std::vector<DegreeScore> cross_validate(const TemperatureProblem& problem) {
  const MatrixXd scores = fold_scores(problem);
  Index best = 0;
  scores.colwise().mean().minCoeff(&best);
  std::vector<DegreeScore> found;
  for (Index degree = 0; degree < scores.cols(); ++degree) {
    const VectorXd excess = scores.col(degree) - scores.col(best);
    const double squares = (excess.array() - excess.mean()).square().sum();
    found.push_back({static_cast<int>(degree), scores.col(degree).mean(), excess.mean(),
                     std::sqrt(squares / static_cast<double>(folds * (folds - 1)))});
  }
  return found;
}

int chosen_degree(const TemperatureProblem& problem, const std::vector<DegreeScore>& scores) {
  // For a noiseless recording only the last digits would differ.
  const double rounding = 1e-14 * scores.front().score;
  int degree = 0;
  for (const DegreeScore& score : scores) {
    degree = score.degree;
    if (score.excess <= score.std + rounding) break;
  }
  for (; degree > 0; --degree) {
    const TemperatureCurve curve = fit_curve(problem, degree);
    const Index leading = problem.level + degree;
    if (std::abs(curve.values(leading)) >
        normal_975 * std::sqrt(curve.covariance(leading, leading)))
      break;
  }
  return degree;
}

}  // namespace proofmass::characterise
