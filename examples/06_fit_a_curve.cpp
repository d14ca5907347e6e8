// Fits a user-defined curve to noisy measurements: the parameters with their errors, the band of
// the curve, and the same fit with the linear parameters eliminated.
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "proofmass/fit/curve.hpp"
#include "proofmass/fit/variable_projection.hpp"

namespace pm = proofmass;

int main() {
  // A sensor that warms up: 9.81 + 0.05 exp(-t / 300 s), sampled every 2 s.
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal(0.0, 0.005);
  std::vector<double> time_s, accel_mps2;
  for (double t = 0.0; t < 1800.0; t += 2.0) {
    time_s.push_back(t);
    accel_mps2.push_back(9.81 + 0.05 * std::exp(-t / 300.0) + normal(bits));
  }

  const pm::fit::CurveModel warm_up = [](double t, pm::View<double> p) {
    return p[0] + p[1] * std::exp(-t / p[2]);
  };
  const auto fit =
      pm::fit::fit_curve(time_s, accel_mps2, warm_up, std::vector{9.8, 0.1, 100.0}).value();
  const char* names[] = {"offset (m/s^2)", "step (m/s^2)", "time constant (s)"};
  for (std::size_t j = 0; j < 3; ++j)
    std::printf("%-18s %10.5g +- %.2g\n", names[j], fit.parameters[j], fit.std[j]);
  std::printf("%zu degrees of freedom, residuals %.3g m/s^2, %s in %d iterations\n", fit.dof,
              fit.residual_std, fit.converged ? "converged" : "not converged", fit.iterations);

  const std::vector<double> when{0.0, 600.0, 3600.0};
  const auto band = pm::fit::curve_with_band(when, warm_up, fit);
  for (std::size_t k = 0; k < when.size(); ++k)
    std::printf("at %4.0f s  %.5f +- %.5f\n", when[k], band[k].value, band[k].std);

  // For a given time constant the fit is linear: one nonlinear parameter, and no initial values for
  // the other two.
  const auto n = static_cast<Eigen::Index>(time_s.size());
  const auto separable = pm::fit::fit_separable(
      accel_mps2, {.basis =
                       [&](pm::View<double> alpha, Eigen::Ref<Eigen::MatrixXd> columns) {
                         for (Eigen::Index k = 0; k < n; ++k)
                           columns(k, 0) =
                               std::exp(-time_s[static_cast<std::size_t>(k)] / alpha[0]);
                       },
                   .varying_columns = 1,
                   .start = {100.0},
                   .lower = {1.0},
                   .upper = {1e4},
                   .constant = pm::fit::factor_columns(Eigen::MatrixXd::Ones(n, 1))});
  if (!separable) return 1;
  std::printf("again, separated   %10.5g +- %.2g\n", separable->alpha[0],
              std::sqrt(separable->covariance(0, 0)));

  const bool same = std::abs(separable->alpha[0] / fit.parameters[2] - 1.0) < 1e-6;
  const bool right = std::abs(fit.parameters[2] - 300.0) < 4.0 * fit.std[2];
  return fit.converged && same && right ? 0 : 1;
}
