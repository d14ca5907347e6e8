#include "proofmass/characterise/drift/drifting_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double least_pivot = 1e-200;  // of columns that are zero

struct Candidate {
  double drift = 0.0;   // M, relative to the white variance
  double memory = 1.0;  // in blocks
  double prior = 1.0;
  double loss = 0.0, white_variance = 0.0;
};

// A Markov process x of variance 1, at a block's start and end and as its mean over the block,
//     mean = g x0 + η,     x1 = φ x0 + ξ.
// The means of a random walk are no random walk: their steps are correlated by a quarter.
struct BlockAverages {
  double phi, g, mean_variance;

  explicit BlockAverages(double memory)
      : phi(std::exp(-1.0 / memory)),
        g(-memory * std::expm1(-1.0 / memory)),
        mean_variance(2.0 * memory * (1.0 - g)) {}

  [[nodiscard]] double eta_variance() const { return mean_variance - g * g; }
  [[nodiscard]] double xi_variance() const { return 1.0 - phi * phi; }
  [[nodiscard]] double eta_xi() const { return g * (1.0 - phi); }
};

// The part of each column not explained by the previous ones: the pivots of elimination.
VectorXd pivots(MatrixXd A) {
  VectorXd found(A.rows());
  const VectorXd size = A.diagonal();
  for (Index k = 0; k < A.rows(); ++k) {
    found(k) = std::max({A(k, k), 1e-28 * size(k), least_pivot});
    for (Index i = k + 1; i < A.rows(); ++i) A.row(i) -= A(i, k) / found(k) * A.row(k);
  }
  return found;
}

// By the Kalman filter of the Markov process, which whitens all columns at once.
void weigh(Candidate& candidate, const MatrixXd& transposed, const std::vector<double>& places) {
  const Index n = transposed.cols(), causes = transposed.rows() - 1;
  const BlockAverages average(candidate.memory);
  const double M = candidate.drift, phi = average.phi, g = average.g;
  MatrixXd white = transposed;
  VectorXd state = VectorXd::Zero(transposed.rows());
  double P = M, log_determinant = 0.0;
  for (Index t = 0; t < n; ++t) {
    const double F = g * g * P + M * average.eta_variance() + 1.0;
    const double K = (phi * g * P + M * average.eta_xi()) / F;
    log_determinant += std::log(F);
    white.col(t) -= g * state;
    state = phi * state + K * white.col(t);
    P = phi * phi * P + M * average.xi_variance() - K * K * F;
    white.col(t) /= std::sqrt(F);
    const auto k = static_cast<std::size_t>(t);
    if (t + 1 == n || places[k + 1] - places[k] < 1.5) continue;
    const double missed = std::exp(-(places[k + 1] - places[k] - 1.0) / candidate.memory);
    state *= missed;
    P = missed * missed * (P - M) + M;
  }
  const VectorXd pivot = pivots(white * white.transpose());
  const auto degrees = static_cast<double>(n - causes);
  candidate.white_variance = pivot(causes) / degrees;
  candidate.loss = degrees * std::log(candidate.white_variance) + log_determinant +
                   pivot.head(causes).array().log().sum();
}

std::vector<Candidate> candidates(double longest) {
  std::vector<Candidate> all;
  for (double memory = longest; memory > 0.9; memory /= 4.0) {
    const double fresh = BlockAverages(memory).xi_variance();
    for (double step = 1e-5; step < 1e4; step *= 2.0)
      all.push_back({step / fresh, memory, memory * std::sqrt(step)});
  }
  return all;
}

}  // namespace

DriftingNoise likely_noise(const MatrixXd& columns, const std::vector<double>& places) {
  const double length = places.back() - places.front() + 1.0;
  std::vector<Candidate> all = candidates(4.0 * length);
  const MatrixXd transposed = columns.transpose();
  for (Candidate& candidate : all) weigh(candidate, transposed, places);
  const double least = std::ranges::min(all, {}, &Candidate::loss).loss;
  DriftingNoise noise;
  noise.drift.assign(static_cast<std::size_t>(length), 0.0);
  const auto weight_of = [=](const Candidate& candidate) {
    return candidate.prior * std::exp(0.5 * (least - candidate.loss));
  };
  double sum = 0.0;
  for (const Candidate& candidate : all) sum += weight_of(candidate);
  for (const Candidate& candidate : all) {
    const double weight = weight_of(candidate) / sum;
    if (weight < 1e-9) continue;
    noise.white_variance += weight * candidate.white_variance;
    const BlockAverages average(candidate.memory);
    const double variance = weight * candidate.white_variance * candidate.drift;
    noise.drift[0] += variance * average.mean_variance;
    double covariance = variance * average.g * average.g;
    for (std::size_t lag = 1; lag < noise.drift.size(); ++lag) {
      noise.drift[lag] += covariance;
      covariance *= average.phi;
    }
  }
  return noise;
}

MatrixXd drift_covariance(const DriftingNoise& noise, const std::vector<double>& places) {
  const auto n = static_cast<Index>(places.size());
  MatrixXd V(n, n);
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k <= i; ++k) {
      const double lag = places[static_cast<std::size_t>(i)] - places[static_cast<std::size_t>(k)];
      V(i, k) = V(k, i) = noise.drift[static_cast<std::size_t>(lag)];
    }
  }
  return V;
}

}  // namespace proofmass::characterise
