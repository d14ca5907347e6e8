#include "proofmass/estimate/motor/level_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double block_s = 1.0;
constexpr double least_ratio = 1e-7, most_ratio = 1e5;  // 1/s

// Rows transformed to independent ones of unit variance in units of the white noise.
struct Whitened {
  MatrixXd columns;
  double log_variance = 0.0;  // Σ ln S
  std::size_t rows = 0;       // that have an innovation: all but the first after each start
};

Whitened whiten(const LevelRegression& regression, const MatrixXd& columns, double ratio) {
  Whitened out{.columns = MatrixXd::Zero(columns.rows(), columns.cols())};
  VectorXd level = VectorXd::Zero(columns.rows());
  double variance = 0.0;
  std::size_t next_start = 0;
  for (Index k = 0; k < columns.cols(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (next_start < regression.starts.size() && regression.starts[next_start] == at) {
      level += columns.col(k) - level;
      variance = 1.0;
      ++next_start;
      continue;
    }
    variance += ratio * (regression.time_s[at] - regression.time_s[at - 1]);
    const double S = variance + 1.0, gain = variance / S;
    out.columns.col(k) = (columns.col(k) - level) / std::sqrt(S);
    level += gain * (columns.col(k) - level);
    variance = gain;
    out.log_variance += std::log(S);
    ++out.rows;
  }
  return out;
}

// M⁻¹ with M in units where the priors have a standard deviation of 1, which conditions it.
MatrixXd scaled_inverse(const MatrixXd& M, const VectorXd& prior_std) {
  const auto scale = prior_std.asDiagonal();
  return scale * positive_inverse(scale * M * scale) * scale;
}

MatrixXd widened(const LevelRegression& regression, const LevelFit& fit, const MatrixXd& model) {
  const Index p = regression.unknowns();
  MatrixXd scatter = MatrixXd::Zero(p, p);
  VectorXd part = VectorXd::Zero(p);
  double end_s = regression.time_s.front() + block_s, blocks = 1.0;
  for (Index k = 0; k < fit.whitened.cols(); ++k) {
    if (regression.time_s[static_cast<std::size_t>(k)] >= end_s) {
      scatter += part * part.transpose();
      part.setZero();
      blocks += 1.0;
      end_s = regression.time_s[static_cast<std::size_t>(k)] + block_s;
    }
    const auto x = fit.whitened.col(k).head(p);
    part += (fit.whitened(p, k) - x.dot(fit.value)) * x;
  }
  scatter += part * part.transpose();
  // The fit takes a share of the scatter, as it does of the residuals.
  scatter *= blocks / std::max(blocks - static_cast<double>(p), 0.25 * blocks);
  const MatrixXd robust = model * scatter * model;
  VectorXd factor(p);
  for (Index i = 0; i < p; ++i) factor(i) = std::sqrt(std::max(1.0, robust(i, i) / model(i, i)));
  return factor.asDiagonal() * model * factor.asDiagonal();
}

double correlation_of(const LevelFit& fit) {
  const Index p = fit.value.size();
  double squares = 0.0, products = 0.0, last = 0.0;
  for (Index k = 0; k < fit.whitened.cols(); ++k) {
    const double z = fit.whitened(p, k) - fit.whitened.col(k).head(p).dot(fit.value);
    squares += z * z;
    products += z * last;
    last = z;
  }
  return squares > 0.0 ? products / squares : 0.0;
}

}  // namespace

LevelFit fit_at(const LevelRegression& regression, double ratio) {
  const Index p = regression.unknowns();
  PM_EXPECTS(regression.columns.cols() > p);
  PM_EXPECTS(!regression.starts.empty() && regression.starts.front() == 0);
  const Whitened rows = whiten(regression, regression.columns, ratio);
  const MatrixXd squares = rows.columns * rows.columns.transpose();
  const VectorXd precision = regression.prior_std.array().square().inverse();
  const double n = std::max(static_cast<double>(rows.rows), 1.0);
  LevelFit out{.ratio = ratio};
  // The priors are in the units of β, the rows in those of the white noise, which is found with it.
  double variance = std::max(squares(p, p) / n, std::numeric_limits<double>::min());
  for (int round = 0; round < 4; ++round) {
    MatrixXd M = squares.topLeftCorner(p, p) / variance;
    M.diagonal() += precision;
    out.model_covariance = scaled_inverse(M, regression.prior_std);
    out.value = out.model_covariance *
                (squares.col(p).head(p) / variance + precision.cwiseProduct(regression.prior_mean));
    const double rest = squares(p, p) - 2.0 * out.value.dot(squares.col(p).head(p)) +
                        out.value.dot(squares.topLeftCorner(p, p) * out.value);
    variance = std::max(rest / std::max(n - static_cast<double>(p), 1.0),
                        1e-24 * (squares(p, p) / n) + std::numeric_limits<double>::min());
  }
  const VectorXd off = (out.value - regression.prior_mean).cwiseQuotient(regression.prior_std);
  out.cost = n * std::log(variance) + rows.log_variance + off.squaredNorm();
  out.white_std = std::sqrt(variance);
  out.whitened = rows.columns / out.white_std;
  return out;
}

LevelFit fit(const LevelRegression& regression) {
  // Golden section on ln ratio: −2 ln L has one minimum, or falls towards one end.
  constexpr double golden = 0.6180339887498949;
  double low = std::log(least_ratio), high = std::log(most_ratio);
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double cost_a = fit_at(regression, std::exp(a)).cost;
  double cost_b = fit_at(regression, std::exp(b)).cost;
  while (high - low > 0.05) {
    if (cost_a < cost_b) {
      high = b;
      b = a;
      cost_b = cost_a;
      a = high - golden * (high - low);
      cost_a = fit_at(regression, std::exp(a)).cost;
    } else {
      low = a;
      a = b;
      cost_a = cost_b;
      b = low + golden * (high - low);
      cost_b = fit_at(regression, std::exp(b)).cost;
    }
  }
  LevelFit out = fit_at(regression, std::exp(0.5 * (low + high)));
  out.covariance = widened(regression, out, out.model_covariance);
  out.correlation = correlation_of(out);
  return out;
}

MatrixXd response(const LevelRegression& regression, const LevelFit& fit, const MatrixXd& targets) {
  const Index p = regression.unknowns();
  const MatrixXd rows = whiten(regression, targets.transpose(), fit.ratio).columns / fit.white_std;
  return fit.model_covariance * (fit.whitened.topRows(p) * rows.transpose());
}

std::vector<double> smoothed_level(const LevelRegression& regression, const LevelFit& fit) {
  const Index p = regression.unknowns();
  const auto n = static_cast<std::size_t>(regression.columns.cols());
  std::vector<double> level(n), filtered_variance(n);
  std::vector<bool> starts(n + 1, false);
  for (const std::size_t k : regression.starts) starts[k] = true;
  for (std::size_t k = 0; k < n; ++k) {
    const auto row = regression.columns.col(static_cast<Index>(k));
    const double y = row(p) - row.head(p).dot(fit.value);
    if (starts[k]) {
      level[k] = y;
      filtered_variance[k] = 1.0;
      continue;
    }
    const double predicted =
        filtered_variance[k - 1] + fit.ratio * (regression.time_s[k] - regression.time_s[k - 1]);
    filtered_variance[k] = predicted / (predicted + 1.0);
    level[k] = level[k - 1] + filtered_variance[k] * (y - level[k - 1]);
  }
  // Rauch, Tung and Striebel's backward pass.
  for (std::size_t k = n - 1; k-- > 0;) {
    if (starts[k + 1]) continue;
    const double predicted =
        filtered_variance[k] + fit.ratio * (regression.time_s[k + 1] - regression.time_s[k]);
    level[k] += filtered_variance[k] / predicted * (level[k + 1] - level[k]);
  }
  return level;
}

}  // namespace proofmass::estimate::motor
