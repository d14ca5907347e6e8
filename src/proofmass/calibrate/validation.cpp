#include "proofmass/calibrate/validation.hpp"

#include <cmath>

#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::calibrate {

Validation validate(const MultiPosition& fit, View<Pose> poses) {
  PM_EXPECTS(!poses.empty());
  const Parameters p(fit.estimate.data());
  Validation out;
  double squares = 0.0, expected = 0.0, chi_square = 0.0;
  bool noise_known = true;
  for (const Pose& pose : poses) {
    const NormTerm term = norm_term(p, {pose.mean, pose.mean_covariance});
    const double residual = term.force.norm() - fit.gravity_mps2;
    // |f| − 1 and |f| have the same gradient; the uncertainty of gravity is in the scales'
    // covariance.
    const double variance =
        term.variance + (term.gradient * fit.covariance * term.gradient.transpose()).value();
    noise_known &= term.variance > 0.0;
    out.residuals_mps2.push_back(residual);
    squares += residual * residual;
    expected += variance;
    chi_square += residual * residual / variance;
  }
  const auto n = static_cast<double>(poses.size());
  out.rms_mps2 = std::sqrt(squares / n);
  out.expected_rms_mps2 = std::sqrt(expected / n);
  if (noise_known) out.p = chi_square_p(chi_square, n);
  return out;
}

}  // namespace proofmass::calibrate
