#pragma once

#include <Eigen/Core>
#include <vector>

// Noise that several runs have in common, from what is left of them.
namespace proofmass::characterise {

enum class RunNoiseKind { white, flicker, random_walk, markov };

/// A noise of unit strength, times in lengths of the run: its Allan variance is 1/τ, 2 ln 2 / π,
/// τ/3, and of Markov noise its variance is 1.
struct RunNoiseTerm {
  RunNoiseKind kind = RunNoiseKind::white;
  double memory = 0.0;  ///< of Markov noise
};

/// A variance as one of several models has it, as likely as its weight says.
struct VarianceEstimate {
  double value = 0.0;
  double std = 0.0;
  double weight = 1.0;
};

/// A sum of noises of given kinds, as likely as its weight says.
struct RunNoiseModel {
  std::vector<RunNoiseTerm> terms;
  Eigen::VectorXd strengths;   ///< u²
  Eigen::MatrixXd covariance;  ///< of the strengths
  double weight = 1.0;         ///< of all models together 1
};

/// What is known of the noise. Of runs without any there is no model, and every variance is 0.
struct RunNoise {
  double duration_s = 0.0;
  std::vector<RunNoiseModel> models;

  /// Half the mean square by which the means of two neighbouring stretches differ.
  [[nodiscard]] std::vector<VarianceEstimate> allan_variance(double tau_s) const;
  /// Of the mean over the last window_s less that over the first.
  [[nodiscard]] std::vector<VarianceEstimate> change_variance(double window_s) const;
  /// Mean over the models, of each cosine coefficient of `blocks` block means, k = 1 … blocks − 1.
  [[nodiscard]] Eigen::VectorXd ordinates(Eigen::Index blocks) const;
};

/// The orthonormal cosine transform of each column, k = 1 … n − 1: what a level has no part in.
[[nodiscard]] Eigen::MatrixXd cosine_coefficients(const Eigen::MatrixXd& columns);

/// Fits residuals of a two-way table, a row a block and a column a run, R runs: the mean squares
/// P_k = Σ z_ik² / (R − 1) of their cosine coefficients as chi-square variables of R − 1 degrees of
/// freedom about v_k = Σ θ_j a_jk,
///
///     −2 ln L = (R − 1) Σ (ln v_k + P_k / v_k),
///
/// the least of it by WhittleLikelihood for each choice of up to three terms. No choice is made
/// between them but each has its Akaike weight w ∝ exp(−AIC/2): a wander that is large over the
/// length of a run may be too small within it to be chosen with certainty, and to leave it out
/// would make the runs differ. a_jk is exact; that the coefficients are independent is so for white
/// noise and random walks, and near enough for the others. Source: S. T. Buckland, K. P. Burnham,
/// N. H. Augustin, Model selection: an integral part of inference, Biometrics 53 (1997) 603,
/// section 2. Cost: some milliseconds.
[[nodiscard]] RunNoise fit_run_noise(const Eigen::MatrixXd& residuals, double duration_s);

}  // namespace proofmass::characterise
