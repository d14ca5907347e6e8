#include "proofmass/estimate/motor/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double block_s = 1.0;

struct Study {
  const Series& series;
  const Regimes& regimes;
  std::vector<std::size_t> free;
};

double cost_of(const Study& study, const Parameters& p, Innovations& work) {
  filter(study.series, study.regimes, p, work);
  double cost = work.cost();
  for (const std::size_t i : study.free)
    cost += std::pow((p.value[i] - p.prior_mean[i]) / p.prior_std[i], 2);
  return cost;
}

// Gradient of half the cost, information, and the scatter of the score.
struct Score {
  VectorXd gradient;
  MatrixXd information, scatter;
};

// Derivatives of the innovations and of their variances, scaled: ∂e/√S and ∂S/(√2 S).
MatrixXd sensitivities(const Study& study, const Parameters& p, const Innovations& at) {
  const std::size_t n = at.value.size();
  MatrixXd D(static_cast<Index>(2 * n), static_cast<Index>(study.free.size()));
  Innovations up;
  for (std::size_t j = 0; j < study.free.size(); ++j) {
    const std::size_t i = study.free[j];
    const double h = 1e-5 * (is_log(i) ? 1.0 : std::max(std::abs(p.value[i]), 1e-2 * p.prior_std[i]));
    Parameters moved = p;
    moved.value[i] = p.value[i] + h;
    filter(study.series, study.regimes, moved, up);
    for (std::size_t k = 0; k < n; ++k) {
      const auto row = static_cast<Index>(2 * k), column = static_cast<Index>(j);
      const double S = at.variance[k];
      D(row, column) = S > 0.0 ? (up.value[k] - at.value[k]) / (h * std::sqrt(S)) : 0.0;
      D(row + 1, column) =
          S > 0.0 ? (up.variance[k] - S) / (h * std::sqrt(2.0) * S) : 0.0;
    }
  }
  return D;
}

Score score_of(const Study& study, const Parameters& p, const Innovations& at) {
  const MatrixXd D = sensitivities(study, p, at);
  const auto m = static_cast<Index>(study.free.size());
  Score out{.gradient = VectorXd::Zero(m), .information = D.transpose() * D,
            .scatter = MatrixXd::Zero(m, m)};
  const auto per_block =
      std::max<std::size_t>(3, 3 * static_cast<std::size_t>(block_s / study.series.step_s));
  std::size_t blocks = 0;
  for (std::size_t first = 0; first < at.value.size(); first += per_block) {
    VectorXd part = VectorXd::Zero(m);
    for (std::size_t k = first; k < std::min(first + per_block, at.value.size()); ++k) {
      if (!(at.variance[k] > 0.0)) continue;
      const double z = at.value[k] / std::sqrt(at.variance[k]);
      const auto row = static_cast<Index>(2 * k);
      part += z * D.row(row).transpose() +
              std::sqrt(0.5) * (1.0 - z * z) * D.row(row + 1).transpose();
    }
    out.gradient += part;
    out.scatter += part * part.transpose();
    ++blocks;
  }
  for (Index j = 0; j < m; ++j) {
    const std::size_t i = study.free[static_cast<std::size_t>(j)];
    const double precision = 1.0 / std::pow(p.prior_std[i], 2);
    out.gradient(j) += precision * (p.value[i] - p.prior_mean[i]);
    out.information(j, j) += precision;
  }
  return out;
}

// A shortened step if the filter fails there or the cost does not fall.
bool step(const Study& study, const Score& score, Fit& fit, Innovations& work, double& damping) {
  const auto m = static_cast<Index>(study.free.size());
  for (int attempt = 0; attempt < 8; ++attempt) {
    MatrixXd M = score.information;
    for (Index j = 0; j < m; ++j) M(j, j) *= 1.0 + damping;
    const VectorXd move = -(positive_inverse(M) * score.gradient);
    Parameters next = fit.parameters;
    double share = 1.0;
    for (Index j = 0; j < m; ++j) {
      const std::size_t i = study.free[static_cast<std::size_t>(j)];
      const double most = is_log(i) ? 1.5 : 2.0 * fit.parameters.prior_std[i];
      if (std::abs(move(j)) > most) share = std::min(share, most / std::abs(move(j)));
    }
    for (Index j = 0; j < m; ++j)
      next.value[study.free[static_cast<std::size_t>(j)]] += share * move(j);
    const double cost = cost_of(study, next, work);
    if (std::isfinite(cost) && cost < fit.cost + 1e-9 * std::abs(fit.cost)) {
      const double gain = fit.cost - cost;
      fit.parameters = next;
      fit.cost = cost;
      damping *= 0.2;
      fit.converged = gain < 0.02;
      return true;
    }
    damping = std::max(10.0 * damping, 1e-3);
  }
  return false;
}

MatrixXd covariance_of(const Study& study, const Score& score) {
  const MatrixXd model = positive_inverse(score.information);
  const MatrixXd robust = model * score.scatter * model;
  const auto m = static_cast<Index>(study.free.size());
  MatrixXd out = MatrixXd::Zero(parameter_count, parameter_count);
  VectorXd factor(m);
  for (Index j = 0; j < m; ++j)
    factor(j) = std::sqrt(std::max(1.0, robust(j, j) / model(j, j)));
  for (Index j = 0; j < m; ++j)
    for (Index l = 0; l < m; ++l)
      out(static_cast<Index>(study.free[static_cast<std::size_t>(j)]),
          static_cast<Index>(study.free[static_cast<std::size_t>(l)])) =
          model(j, l) * factor(j) * factor(l);
  return out;
}

}  // namespace

Fit maximise(const Series& series,
             const Regimes& regimes,
             const Parameters& start,
             int most_iterations) {
  Study study{.series = series, .regimes = regimes, .free = {}};
  for (std::size_t i = 0; i < parameter_count; ++i)
    if (start.active[i]) study.free.push_back(i);
  Innovations at, work;
  Fit fit{.parameters = start, .covariance = {}, .cost = cost_of(study, start, at)};
  double damping = 1e-3;
  Score score = score_of(study, fit.parameters, at);
  while (fit.iterations < most_iterations && !fit.converged) {
    ++fit.iterations;
    if (!step(study, score, fit, work, damping)) {
      fit.converged = true;
      break;
    }
    std::swap(at, work);
    score = score_of(study, fit.parameters, at);
  }
  fit.covariance = covariance_of(study, score);
  return fit;
}

}  // namespace proofmass::estimate::motor
