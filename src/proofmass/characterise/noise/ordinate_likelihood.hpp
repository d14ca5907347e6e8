#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// Model of the mean of independent normal ordinates z.
struct OrdinateMeans {
  /// X: the mean is X b with b free.
  Eigen::MatrixXd fitted;
  /// X̃: columns for which the restricted likelihood corrects; may include those of nonlinear
  /// parameters in addition to X, and is the same in all compared likelihoods.
  Eigen::MatrixXd adjusting;
  /// Blocks j whose impulses c cos(π k (j + ½)/n), k = 1 … n − 1, are the last columns of both (of
  /// X̃ if it has any).
  View<std::size_t> impulses = {};
};

/// Products Xᵀ diag(w) X, where the last columns of X are the impulses of these blocks. A product
/// of two cosines is half a sum of cosines of the blocks' difference and sum, so that those of m
/// impulses cost O(m²) after one transform of the weights, instead of O(n m²).
class GramOfColumns {
 public:
  /// Both must outlive it.
  GramOfColumns(View<std::size_t> impulses, const Eigen::VectorXd& w);

  [[nodiscard]] Eigen::MatrixXd of(const Eigen::MatrixXd& X) const;

 private:
  [[nodiscard]] Eigen::MatrixXd of_impulses(const Eigen::VectorXd& first) const;

  View<std::size_t> impulses_;
  const Eigen::VectorXd& w_;
  std::vector<double> sums_;  ///< Σ w cos(π k d/n) of the lags d; none for few impulses
};

struct OrdinateFit {
  Eigen::VectorXd strength;      ///< θ, one a column of P
  Eigen::VectorXd density;       ///< S = P θ, one an ordinate
  Eigen::VectorXd coefficients;  ///< b
  Eigen::MatrixXd covariance;    ///< of b, given S
  double log_likelihood = 0.0;
};

/// Generalised least squares with fitted noise: maximises
///
///     ℓ(θ) = −½ Σ [ln S + (z − X b)²/S] − ½ ln |X̃ᵀ S⁻¹ X̃|,     S = P θ,  θ ≥ 0,
///
/// with b at its weighted least squares value. Without X̃ this is the likelihood, with X̃ = X the
/// restricted one; with the tangent of a curve it is the adjusted profile likelihood of what the
/// curve depends on, which does not underestimate the noise after a fit. Source: H. D. Patterson,
/// R. Thompson, Biometrika 58 (1971) 545; D. R. Cox, N. Reid, J. Roy. Statist. Soc. B 49 (1987) 1.
/// By Fisher scoring as in noise/whittle.hpp.
///
/// start: a θ to begin from; empty: from the smoothed squares of z.
[[nodiscard]] OrdinateFit fit_ordinates(const Eigen::VectorXd& z,
                                        const Eigen::MatrixXd& P,
                                        const OrdinateMeans& means,
                                        const Eigen::VectorXd& start = {});

/// Largest expected gain of one of these columns c, of strength zero so far, in twice the
/// log-likelihood, by its score test: (½ Σ c (p − S)/S²)² over the part of its information ½ Σ
/// c²/S² not shared by the strengths above zero, p the expected squares; 0 for a negative score.
/// Source: C. R. Rao, Proc. Camb. Phil. Soc. 44 (1948) 50.
[[nodiscard]] double promised_gain(const Eigen::VectorXd& z,
                                   const Eigen::MatrixXd& P,
                                   const OrdinateMeans& means,
                                   const OrdinateFit& fit,
                                   View<Eigen::VectorXd> columns);

/// fit_ordinates with θ given.
[[nodiscard]] OrdinateFit evaluate_ordinates(const Eigen::VectorXd& z,
                                             const Eigen::MatrixXd& P,
                                             const OrdinateMeans& means,
                                             const Eigen::VectorXd& strength);

}  // namespace proofmass::characterise
