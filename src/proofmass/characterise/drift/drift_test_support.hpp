#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/core/linalg.hpp"

// Warm-ups with known parameters, and their time-domain solution by dense matrices.
namespace proofmass::characterise::test {

/// a1 (1 − e^(−t/T)), sampled at t = (k + ½)/rate.
inline Series warm_up(double a1, double time_constant_s, double rate_hz, std::size_t n) {
  Series y(n);
  for (std::size_t k = 0; k < n; ++k)
    y[k] = -a1 * std::expm1(-(static_cast<double>(k) + 0.5) / (rate_hz * time_constant_s));
  return y;
}

/// A step of this size at a given sample.
inline Series step_at(std::size_t from, double size, std::size_t n) {
  Series y(n, 0.0);
  for (std::size_t k = from; k < n; ++k) y[k] = size;
  return y;
}

inline Series level(double value, std::size_t n) {
  return Series(n, value);
}

/// Evidence from means over this many samples each.
inline DriftEvidence evidence_of(const Series& samples,
                                 const Sampling& sampling,
                                 double start_s = 0.0) {
  Series means(samples.size() / sampling.block, 0.0);
  for (std::size_t j = 0; j < means.size(); ++j)
    for (std::size_t k = 0; k < sampling.block; ++k)
      means[j] += samples[j * sampling.block + k] / static_cast<double>(sampling.block);
  return DriftEvidence::make(means, sampling, start_s).value();
}

/// A normal vector y = X b + e with the covariance V of e.
struct DenseModel {
  Eigen::MatrixXd V, X;
};

struct DenseFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;              ///< of the coefficients
  Eigen::MatrixXd inverse;                 ///< V⁻¹
  Eigen::VectorXd residual;                ///< y − X b
  double restricted_log_likelihood = 0.0;  ///< up to a constant
};

/// −½ [ln |V| + ln |XᵀV⁻¹X| + eᵀV⁻¹e], generalised least squares in the time domain.
inline DenseFit fit_dense(const Eigen::VectorXd& y, const DenseModel& model) {
  DenseFit fit;
  const PositiveInverse of_noise = invert_positive(model.V);
  const PositiveInverse of_fit = invert_positive(model.X.transpose() * of_noise.inverse * model.X);
  fit.inverse = of_noise.inverse;
  fit.covariance = of_fit.inverse;
  fit.coefficients = of_fit.inverse * (model.X.transpose() * (of_noise.inverse * y));
  fit.residual = y - model.X * fit.coefficients;
  fit.restricted_log_likelihood = -0.5 * (of_noise.log_determinant + of_fit.log_determinant +
                                          fit.residual.dot(of_noise.inverse * fit.residual));
  return fit;
}

/// Covariance of samples (k + ½) h after power-on: white noise and a random walk that is zero at
/// power-on.
inline Eigen::MatrixXd white_and_walk(double N, double K, double step_s, Eigen::Index n) {
  Eigen::MatrixXd V(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      V(i, j) = K * K * step_s * (static_cast<double>(std::min(i, j)) + 0.5) +
                (i == j ? N * N / step_s : 0.0);
  return V;
}

inline Eigen::VectorXd vector_of(const Series& y) {
  return Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
}

}  // namespace proofmass::characterise::test
