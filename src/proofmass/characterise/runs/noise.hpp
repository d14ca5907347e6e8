#pragma once

#include <Eigen/Core>
#include <vector>

// Common noise of several runs, from their residuals.
namespace proofmass::characterise {

enum class RunNoiseKind { white, flicker, random_walk, markov };

/// A noise of unit strength, times in lengths of the run: its Allan variance is 1/τ, 2 ln 2 / π,
/// τ/3, and of Markov noise its variance is 1.
struct RunNoiseTerm {
  RunNoiseKind kind = RunNoiseKind::white;
  double memory = 0.0;  ///< of Markov noise
};

/// A variance by one of several models, with the model's weight.
struct VarianceEstimate {
  double value = 0.0;
  double std = 0.0;
  double weight = 1.0;
};

/// A sum of noise types, with its weight.
struct RunNoiseModel {
  std::vector<RunNoiseTerm> terms;
  Eigen::VectorXd strengths;   ///< u²
  Eigen::MatrixXd covariance;  ///< of the strengths
  double weight = 1.0;         ///< of all models together 1
};

/// The noise models. Noiseless runs have no model, and every variance is 0.
struct RunNoise {
  double duration_s = 0.0;
  std::vector<RunNoiseModel> models;

  /// Half the mean square difference of the means of two neighbouring stretches.
  [[nodiscard]] std::vector<VarianceEstimate> allan_variance(double tau_s) const;
  /// Variance of the mean over the last window_s minus that over the first.
  [[nodiscard]] std::vector<VarianceEstimate> change_variance(double window_s) const;
  /// Mean over the models of the variance of each cosine coefficient of `blocks` block means, k = 1
  /// … blocks − 1.
  [[nodiscard]] Eigen::VectorXd ordinates(Eigen::Index blocks) const;
};

/// The orthonormal cosine transform of each column, k = 1 … n − 1, which does not depend on a
/// level.
[[nodiscard]] Eigen::MatrixXd cosine_coefficients(const Eigen::MatrixXd& columns);

/// Fits residuals of a two-way table, a row a block and a column a run, R runs: the mean squares
/// P_k = Σ z_ik² / (R − 1) of their cosine coefficients as chi-square variables of R − 1 degrees of
/// freedom about v_k = Σ θ_j a_jk,
///
///     −2 ln L = (R − 1) Σ (ln v_k + P_k / v_k),
///
/// minimised by WhittleLikelihood for each choice of up to three terms. Each choice has its Akaike
/// weight w ∝ exp(−AIC/2): drift that is large over the length of a run may be too small within it
/// to be selected with certainty, and omitting it would make the runs differ. a_jk is exact; that
/// the coefficients are independent is so for white noise and random walks, and near enough for the
/// others. Source: S. T. Buckland, K. P. Burnham, N. H. Augustin, Model selection: an integral part
/// of inference, Biometrics 53 (1997) 603, section 2. Cost: some milliseconds.
[[nodiscard]] RunNoise fit_run_noise(const Eigen::MatrixXd& residuals, double duration_s);

}  // namespace proofmass::characterise
