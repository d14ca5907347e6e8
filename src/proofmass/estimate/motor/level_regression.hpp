#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace proofmass::estimate::motor {

/// Linear regression with noise that is white plus a random walk:
///
///     y = xᵀβ + d(t) + e,   d a random walk that starts anew at some rows.
///
/// What is integrated to form y or x (a voltage, a torque) has errors whose integral is such a
/// walk. Its size relative to the white noise is estimated by maximum likelihood.
struct LevelRegression {
  Eigen::MatrixXd columns;          ///< a row's x and y, one column per row of the regression
  std::vector<double> time_s{};     ///< of each row, not descending
  std::vector<std::size_t> starts;  ///< rows at which d starts anew, ascending, the first 0
  Eigen::VectorXd prior_std;        ///< of β, about prior_mean
  Eigen::VectorXd prior_mean;

  [[nodiscard]] Eigen::Index unknowns() const { return columns.rows() - 1; }
};

struct LevelFit {
  Eigen::VectorXd value{};  ///< β
  Eigen::MatrixXd
      covariance{};  ///< the larger of the model's and the one by the scatter of the score
  Eigen::MatrixXd whitened{};  ///< x and y of each row, in standard deviations of the innovation
  Eigen::MatrixXd model_covariance{};
  double ratio = 0.0;        ///< density of the walk over the white variance, 1/s
  double white_std = 0.0;    ///< of e
  double cost = 0.0;         ///< −2 ln L, up to a constant
  double correlation = 0.0;  ///< of each innovation with the next: 0 if the noise is as modelled
};

/// Generalised least squares. The local level filter of d, with a diffuse start, transforms the
/// rows to independent ones; the likelihood is profiled over β and the white noise.
///
/// The covariance is, for each parameter, the larger of the model's M⁻¹ and of M⁻¹ B M⁻¹ with the
/// scatter B of the score over intervals of a second, which holds if the noise is not as modelled.
/// Expects more rows than unknowns.
///
/// Sources: P. de Jong, The diffuse Kalman filter, Annals of Statistics 19 (1991) 1073; H. White,
/// Maximum likelihood estimation of misspecified models, Econometrica 50 (1982) 1.
[[nodiscard]] LevelFit fit(const LevelRegression& regression);

/// The same with the ratio given, for comparisons between models.
[[nodiscard]] LevelFit fit_at(const LevelRegression& regression, double ratio);

/// Change of β with y: one column for each column of `targets`, which has a row for each row of the
/// regression.
[[nodiscard]] Eigen::MatrixXd response(const LevelRegression& regression,
                                       const LevelFit& fit,
                                       const Eigen::MatrixXd& targets);

/// d at each row, smoothed, after subtraction of xᵀβ.
[[nodiscard]] std::vector<double> smoothed_level(const LevelRegression& regression,
                                                 const LevelFit& fit);

}  // namespace proofmass::estimate::motor
