#include "proofmass/calibrate/tumble/regression.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/calibrate/tumble/components.hpp"
#include "proofmass/calibrate/tumble/scatter.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double beyond_chance = 0.01;

// Sensitivity to the indexing error of each setting, as a vector over the positions.
std::vector<Eigen::VectorXd> setting_levers(const TumbleErrors& errors) {
  const std::size_t count = 1 + *std::max_element(errors.setting.begin(), errors.setting.end());
  std::vector<Eigen::VectorXd> levers(count, Eigen::VectorXd::Zero(errors.lever.size()));
  for (std::size_t k = 0; k < errors.setting.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    levers[errors.setting[k]](row) = errors.lever(row);
  }
  return levers;
}

// V^(−½) X for V = I + u² Σ v vᵀ, where the vectors v have disjoint supports.
Eigen::MatrixXd whitened(Eigen::MatrixXd X, const std::vector<Eigen::VectorXd>& levers, double u) {
  for (const Eigen::VectorXd& v : levers) {
    const double square = v.squaredNorm();
    if (square <= 0.0) continue;
    const double factor = (1.0 - 1.0 / std::sqrt(1.0 + u * u * square)) / square;
    const Eigen::RowVectorXd along = v.transpose() * X;
    X -= factor * v * along;
  }
  return X;
}

double residual_square(const Eigen::MatrixXd& A, const Eigen::VectorXd& y) {
  const Eigen::MatrixXd inverse = positive_inverse(A.transpose() * A);
  return (y - A * (inverse * (A.transpose() * y))).squaredNorm();
}

// χ² about the best fit to the whitened data; sigma is increased if χ² is significant.
void judge_by_noise(const Eigen::MatrixXd& B, const Eigen::VectorXd& z, TumbleRegression& out) {
  const auto dof = static_cast<double>(B.rows() - B.cols());
  out.sigma = 1.0;
  out.dof = out.noise_dof;
  out.has_scale = true;
  if (dof <= 0.0) return;
  out.chi_square = residual_square(B, z);
  const double p = out.noise_dof > 0.0 ? fisher_f_p(out.chi_square / dof, dof, out.noise_dof)
                                       : chi_square_p(out.chi_square, dof);
  if (p >= beyond_chance) return;
  out.sigma = std::sqrt(out.chi_square / dof);
  out.dof = dof;
}

void judge_by_residuals(const Eigen::MatrixXd& A,
                        const Eigen::VectorXd& y,
                        const std::vector<Eigen::VectorXd>& common,
                        TumbleRegression& out) {
  const auto dof = static_cast<double>(A.rows() - A.cols());
  const TumbleScatter own = common.empty() ? TumbleScatter{std::sqrt(out.rss / dof), dof}
                                           : restricted_scatter(A, y, common);
  out.sigma = own.sigma;
  out.dof = own.dof;
  out.has_scale = true;
}

// χ² of the noise and the stated errors; assumed errors do not count as an explanation of misfit.
double chi_square_as_stated(const Eigen::MatrixXd& A,
                            const Eigen::VectorXd& y,
                            const TumbleErrors& errors) {
  const TumbleSizes stated{.indexing_rad = errors.indexing_assumed ? 0.0 : errors.indexing_std_rad,
                           .drift = errors.drift_assumed ? 0.0 : errors.drift_std};
  return solve_tumble(A, y, errors, stated).chi_square;
}

TumbleRegression regress_with_components(const Eigen::MatrixXd& A,
                                         const Eigen::VectorXd& y,
                                         const TumbleErrors& errors) {
  const TumbleSizes sizes = find_sizes(A, y, errors);
  const TumbleSolved solved = solve_tumble(A, y, errors, sizes);
  TumbleRegression out;
  out.errors = errors;
  out.beta = solved.beta;
  out.residual = y - A * out.beta;
  out.rss = out.residual.squaredNorm();
  out.noise_known = errors.noise_known;
  out.noise_dof = errors.noise_dof;
  out.sigma = sizes.noise;
  out.indexing_std_rad = sizes.indexing_rad;
  out.drift_std = sizes.drift;
  const auto dof = static_cast<double>(A.rows() - A.cols());
  out.has_scale = errors.noise_known || dof > 0.0;
  out.dof = errors.noise_known && sizes.noise <= 1.0 ? errors.noise_dof : dof;
  if (errors.noise_known && dof > 0.0) out.chi_square = chi_square_as_stated(A, y, errors);
  const Eigen::MatrixXd& G = solved.gain;
  const Eigen::MatrixXd by_noise = G * (sizes.noise * errors.noise_std).asDiagonal();
  out.noise_covariance = by_noise * by_noise.transpose();
  const Eigen::MatrixXd by_drift = sizes.drift * G * errors.drift;
  out.drift_covariance = by_drift * by_drift.transpose();
  // V is the sum of the three components; the remainder is that of indexing.
  out.indexing_covariance = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  if (sizes.indexing_rad > 0.0)
    out.indexing_covariance = solved.covariance - out.noise_covariance - out.drift_covariance;
  out.deleted.resize(y.size());
  for (Eigen::Index k = 0; k < y.size(); ++k) out.deleted(k) = solved.deleted(k);
  // r = V P y: the standardised residual equals that of (P y)_k.
  out.residual_variance = Eigen::VectorXd::Zero(y.size());
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double z = out.deleted(k);
    if (solved.projector(k) > 0.0)
      out.residual_variance(k) =
          z * z > 1e-12 ? std::pow(out.residual(k) / z, 2) : 1.0 / solved.projector(k);
  }
  return out;
}

std::vector<Eigen::VectorXd> scaled(std::vector<Eigen::VectorXd> levers, double u) {
  for (Eigen::VectorXd& v : levers) v *= u;
  return levers;
}

}  // namespace

TumbleRegression regress_tumble(const Eigen::MatrixXd& A,
                                const Eigen::VectorXd& y,
                                const TumbleErrors& errors) {
  if (errors.with_components()) return regress_with_components(A, y, errors);
  TumbleRegression out;
  out.errors = errors;
  const Eigen::Index n = A.rows();
  const double u = errors.indexing_std_rad;
  // Below, in units of each position's noise.
  const Eigen::VectorXd root_weight = errors.noise_std.cwiseInverse();
  const Eigen::MatrixXd B = root_weight.asDiagonal() * A;
  const Eigen::VectorXd z = root_weight.cwiseProduct(y);
  const Eigen::MatrixXd cofactor = positive_inverse(B.transpose() * B);
  out.beta = cofactor * (B.transpose() * z);
  out.beta += cofactor * (B.transpose() * (z - B * out.beta));  // one step of iterative
                                                                // refinement
  const Eigen::VectorXd r = z - B * out.beta;
  out.residual = y - A * out.beta;
  out.rss = out.residual.squaredNorm();

  const Eigen::MatrixXd hat = B * cofactor;
  Eigen::VectorXd indexing = Eigen::VectorXd::Zero(n);  // contribution to the variance of each
                                                        // residual
  out.indexing_covariance = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  std::vector<Eigen::VectorXd> levers;
  if (u > 0.0) levers = setting_levers(errors);
  for (Eigen::VectorXd& v : levers) {
    v = v.cwiseProduct(root_weight);
    const Eigen::VectorXd moved = cofactor * (B.transpose() * v);
    indexing += u * u * (v - B * moved).cwiseAbs2();
    out.indexing_covariance += u * u * moved * moved.transpose();
  }

  out.indexing_std_rad = u;
  out.drift_covariance = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  out.noise_known = errors.noise_known;
  out.noise_dof = errors.noise_dof;
  if (errors.noise_known)
    judge_by_noise(whitened(B, levers, u), whitened(z, levers, u), out);
  else if (A.rows() > A.cols())
    judge_by_residuals(A, y, scaled(levers, u), out);
  out.noise_covariance = out.sigma * out.sigma * cofactor;
  const Eigen::VectorXd leverage = hat.cwiseProduct(B).rowwise().sum();
  out.residual_variance = (out.sigma * out.sigma * (Eigen::VectorXd::Ones(n) - leverage) + indexing)
                              .cwiseMax(0.0)
                              .cwiseProduct(errors.noise_std.cwiseAbs2());
  return out;
}

}  // namespace proofmass::calibrate
