#include "proofmass/calibrate/norm_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/fit/nonlinear_least_squares.hpp"

namespace proofmass::calibrate {
namespace {

Parameters widened(View<double> free) {
  Parameters p = Parameters::Zero();
  for (std::size_t k = 0; k < free.size(); ++k) p(static_cast<Eigen::Index>(k)) = free[k];
  return p;
}

// The poses that take part, and by what their residuals are multiplied.
struct Weighted {
  std::vector<const NormalisedPose*> poses;
  std::vector<double> factors;
};

Weighted weighted(View<NormalisedPose> poses, View<double> weights, const Parameters& p) {
  Weighted out;
  out.poses.reserve(poses.size());
  out.factors.reserve(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (weights[k] == 0.0) continue;
    out.poses.push_back(&poses[k]);
    out.factors.push_back(std::sqrt(weights[k] / norm_term(p, poses[k]).variance));
  }
  return out;
}

fit::LeastSquaresProblem problem_of(const Weighted& data,
                                    NormParameters free,
                                    const Parameters& start) {
  const auto count = static_cast<Eigen::Index>(free);
  return {.residuals =
              [&data](View<double> free_values, std::span<double> residuals) {
                const Parameters p = widened(free_values);
                for (std::size_t k = 0; k < residuals.size(); ++k)
                  residuals[k] = data.factors[k] * norm_term(p, *data.poses[k]).residual;
              },
          .residual_count = data.poses.size(),
          .start = std::vector<double>(start.data(), start.data() + count),
          .jacobian =
              [&data, count](View<double> free_values, Eigen::Ref<Eigen::MatrixXd> jacobian) {
                const Parameters p = widened(free_values);
                for (Eigen::Index k = 0; k < jacobian.rows(); ++k) {
                  const auto row = static_cast<std::size_t>(k);
                  jacobian.row(k) =
                      data.factors[row] * norm_term(p, *data.poses[row]).gradient.head(count);
                }
              }};
}

constexpr fit::LeastSquaresOptions known_variance{.unit_variance = true, .search_again = false};

// What a finished descent says of every pose.
NormFit judged(View<NormalisedPose> poses, View<double> weights, const fit::LeastSquaresFit& fit) {
  NormFit out;
  out.p = widened(fit.parameters);
  out.cofactor = fit.covariance;
  out.condition = fit.condition;
  out.converged = fit.converged;
  const Eigen::Index count = out.cofactor.rows();
  out.terms.reserve(poses.size());
  out.leverage.reserve(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const NormTerm& term = out.terms.emplace_back(norm_term(out.p, poses[k]));
    const Eigen::RowVectorXd j = term.gradient.head(count);
    out.leverage.push_back((j * out.cofactor * j.transpose()).value() / term.variance);
    if (weights[k] == 0.0) continue;
    ++out.used;
    out.rss += term.residual * term.residual / term.variance;
  }
  return out;
}

// One step of Gauss and Newton's, with the variances of where it starts.
Parameters newton_step(View<NormalisedPose> poses,
                       View<double> weights,
                       NormParameters free,
                       const Parameters& from) {
  const auto count = static_cast<Eigen::Index>(free);
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const NormTerm term = norm_term(from, poses[k]);
    const Eigen::VectorXd j = term.gradient.head(count);
    const double weight = weights[k] / term.variance;
    N += weight * j * j.transpose();
    right -= weight * term.residual * j;
  }
  Parameters p = from;
  p.head(count) += positive_inverse(N) * right;
  return p;
}

}  // namespace

Result<NormFit> fit_norm(View<NormalisedPose> poses,
                         View<double> weights,
                         NormParameters free,
                         const Parameters& start) {
  constexpr int rounds = 2;
  Parameters p = start;
  if (free == NormParameters::six) p.tail<3>().setZero();
  int iterations = 0;
  for (int round = 1;; ++round) {
    const Weighted data = weighted(poses, weights, p);
    const Result<fit::LeastSquaresFit> fit =
        fit::fit_least_squares(problem_of(data, free, p), known_variance);
    if (!fit) return fit.error();
    iterations += fit->iterations;
    if (round < rounds) {
      p = widened(fit->parameters);
      continue;
    }
    NormFit out = judged(poses, weights, *fit);
    out.iterations = iterations;
    return out;
  }
}

RobustStart robust_start(View<NormalisedPose> poses, NormParameters free, const Parameters& start) {
  constexpr int rounds = 12;
  constexpr double cauchy = 2.385, far = 6.0, std_of_median = 1.4826;
  const auto n = static_cast<double>(poses.size());
  // The median of residuals that were fitted is small by the parameters' share.
  const double shrunk = std::sqrt(n / (n - static_cast<double>(free)));
  RobustStart out{start, std::vector<double>(poses.size(), 1.0)};
  std::vector<double> size(poses.size());
  double s = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const Parameters p = newton_step(poses, out.weights, free, out.p);
    if (!p.allFinite()) break;
    out.p = p;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const NormTerm term = norm_term(p, poses[k]);
      size[k] = std::abs(term.residual) / std::sqrt(term.variance);
    }
    s = std_of_median * shrunk * *median(size);
    if (!(s > 0.0)) break;
    for (std::size_t k = 0; k < poses.size(); ++k)
      out.weights[k] = 1.0 / (1.0 + std::pow(size[k] / s / cauchy, 2));
  }
  for (std::size_t k = 0; k < poses.size(); ++k)
    out.weights[k] = s > 0.0 && size[k] > far * s ? 0.0 : 1.0;
  return out;
}

}  // namespace proofmass::calibrate
