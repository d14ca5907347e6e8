#pragma once

#include <Eigen/Core>

#include "proofmass/core/progress.hpp"
#include "proofmass/estimate/motor/filter.hpp"

namespace proofmass::estimate::motor {

struct Fit {
  Parameters parameters;
  /// Covariance in the coordinates of the search; rows of inactive parameters are zero.
  Eigen::MatrixXd covariance;
  double cost = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// The parameters of highest posterior density given the regimes: the Gaussian likelihood of the
/// innovations e with variances S, and the priors, by Fisher scoring with the information
///
///     M_ij = Σ ∂e_i ∂e_j / S + ½ ∂S_i ∂S_j / S².
///
/// The covariance is the larger, for each parameter, of M⁻¹ and of M⁻¹ B M⁻¹ with the scatter B of
/// the score over intervals of a second, which holds if the noise is not white.
/// Source: N. K. Gupta, R. K. Mehra, Computational aspects of maximum likelihood estimation and
/// reduction in sensitivity function calculations, IEEE Trans. Autom. Control 19 (1974) 774;
/// H. White, Maximum likelihood estimation of misspecified models, Econometrica 50 (1982) 1.
[[nodiscard]] Fit maximise(const Series& series,
                           const Regimes& regimes,
                           const Parameters& start,
                           int most_iterations);

}  // namespace proofmass::estimate::motor
