#include "proofmass/calibrate/multi_position/norm_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>

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

// The poses used, and the root of their residuals' weights: W = root rootᵀ.
struct Whitened {
  std::vector<const NormalisedPose*> poses;
  bool independent;
  Eigen::MatrixXd root;  // its diagonal where they are independent

  void apply(Eigen::Ref<Eigen::MatrixXd> rows) const {
    if (independent)
      rows.array().colwise() *= root.col(0).array();
    else
      rows = (root.transpose() * rows).eval();
  }
};

Whitened whitened(const NormData& data, const std::vector<bool>& used, const Parameters& p) {
  Whitened out{.poses = {}, .independent = data.independent(), .root = {}};
  std::vector<Eigen::Index> rows;
  for (std::size_t k = 0; k < data.poses.size(); ++k) {
    if (!used[k]) continue;
    rows.push_back(static_cast<Eigen::Index>(k));
    out.poses.push_back(&data.poses[k]);
  }
  const ResidualWeights W = residual_weights(data, terms_of(data.poses, p), used);
  if (data.independent())
    out.root = W.diagonal(rows).cwiseSqrt();
  else
    out.root = Eigen::LLT<Eigen::MatrixXd>(W.dense(rows, rows)).matrixL();
  return out;
}

fit::LeastSquaresProblem problem_of(const Whitened& data,
                                    NormParameters free,
                                    const Parameters& start) {
  const auto count = static_cast<Eigen::Index>(free);
  return {.residuals =
              [&data](View<double> free_values, std::span<double> residuals) {
                const Parameters p = widened(free_values);
                for (std::size_t k = 0; k < residuals.size(); ++k)
                  residuals[k] = norm_term(p, *data.poses[k]).residual;
                data.apply(Eigen::Map<Eigen::MatrixXd>(
                    residuals.data(), static_cast<Eigen::Index>(residuals.size()), 1));
              },
          .residual_count = data.poses.size(),
          .start = std::vector<double>(start.data(), start.data() + count),
          .jacobian =
              [&data, count](View<double> free_values, Eigen::Ref<Eigen::MatrixXd> jacobian) {
                const Parameters p = widened(free_values);
                for (Eigen::Index k = 0; k < jacobian.rows(); ++k)
                  jacobian.row(k) =
                      norm_term(p, *data.poses[static_cast<std::size_t>(k)]).gradient.head(count);
                data.apply(jacobian);
              }};
}

constexpr fit::LeastSquaresOptions known_variance{.unit_variance = true, .search_again = false};

// Residual statistics of every pose after a finished descent.
NormFit judged(const NormData& data,
               const std::vector<bool>& used,
               const fit::LeastSquaresFit& fit) {
  NormFit out;
  out.p = widened(fit.parameters);
  out.cofactor = fit.covariance;
  out.condition = fit.condition;
  out.converged = fit.converged;
  out.terms = terms_of(data.poses, out.p);
  out.used = static_cast<std::size_t>(std::ranges::count(used, true));
  Eigen::VectorXd r(static_cast<Eigen::Index>(out.terms.size()));
  for (Eigen::Index k = 0; k < r.size(); ++k)
    r(k) = out.terms[static_cast<std::size_t>(k)].residual;
  // Those not used have no weight, but may have non-finite residuals.
  r = r.array().isFinite().select(r, 0.0);
  out.rss = residual_weights(data, out.terms, used).times(r).col(0).dot(r);
  return out;
}

// One Gauss–Newton step, with the variances at its start.
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

// Squared residuals over their variance.
std::vector<double> squares_of(View<NormalisedPose> poses, const Parameters& p) {
  std::vector<double> out;
  out.reserve(poses.size());
  for (const NormTerm& term : terms_of(poses, p)) {
    const double square = term.residual * term.residual / term.variance;
    out.push_back(std::isfinite(square) ? square : std::numeric_limits<double>::max());
  }
  return out;
}

// The `keep` smallest: their weights 1, those of the others 0, and their sum.
double weigh_smallest(const std::vector<double>& squares,
                      std::size_t keep,
                      std::vector<double>& weights) {
  std::vector<std::size_t> order(squares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return squares[k]; });
  double sum = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    weights[order[rank]] = rank < keep ? 1.0 : 0.0;
    if (rank < keep) sum += squares[order[rank]];
  }
  return sum;
}

}  // namespace

std::vector<NormTerm> terms_of(View<NormalisedPose> poses, const Parameters& p) {
  std::vector<NormTerm> terms;
  terms.reserve(poses.size());
  for (const NormalisedPose& pose : poses) terms.push_back(norm_term(p, pose));
  return terms;
}

Result<NormFit> fit_norm(const NormData& data,
                         const std::vector<bool>& used,
                         NormParameters free,
                         const Parameters& start) {
  constexpr int rounds = 2;
  Parameters p = start;
  if (free == NormParameters::six) p.tail<3>().setZero();
  int iterations = 0;
  for (int round = 1;; ++round) {
    const Whitened rows = whitened(data, used, p);
    const Result<fit::LeastSquaresFit> fit =
        fit::fit_least_squares(problem_of(rows, free, p), known_variance);
    if (!fit) return fit.error();
    iterations += fit->iterations;
    if (round < rounds) {
      p = widened(fit->parameters);
      continue;
    }
    NormFit out = judged(data, used, *fit);
    out.iterations = iterations;
    return out;
  }
}

std::optional<Parameters> refit_norm(View<NormalisedPose> poses,
                                     const ResidualWeights& W,
                                     NormParameters free,
                                     const Parameters& start) {
  constexpr int most_steps = 20;
  constexpr double settled = 1e-10;  // of the range of the readings
  const auto n = static_cast<Eigen::Index>(poses.size()), count = static_cast<Eigen::Index>(free);
  Eigen::MatrixXd J(n, count), WJ(n, count);
  Eigen::VectorXd r(n);
  Parameters p = start;
  for (int step = 0; step < most_steps; ++step) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const NormTerm term = norm_term(p, poses[static_cast<std::size_t>(k)]);
      J.row(k) = term.gradient.head(count);
      r(k) = term.residual;
    }
    if (W.dense.size() > 0)
      WJ.noalias() = W.dense * J;
    else
      WJ.noalias() = W.diagonal.asDiagonal() * J;
    const Eigen::MatrixXd N = J.transpose() * WJ;
    const Eigen::VectorXd moved = -(positive_inverse(N) * (WJ.transpose() * r));
    if (!moved.allFinite()) return std::nullopt;
    p.head(count) += moved;
    if (moved.cwiseAbs().maxCoeff() < settled) return p;
  }
  return std::nullopt;
}

RobustStart robust_start(View<NormalisedPose> poses, NormParameters free, const Parameters& start) {
  constexpr int rounds = 12;
  constexpr double cauchy = 2.385, far = 6.0, std_of_median = 1.4826;
  const auto n = static_cast<double>(poses.size());
  // The median of fitted residuals is reduced by the parameters' share.
  const double shrunk = std::sqrt(n / (n - static_cast<double>(free)));
  RobustStart out{start, std::vector<bool>(poses.size(), true)};
  std::vector<double> size(poses.size()), weights(poses.size(), 1.0);
  double s = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const Parameters p = newton_step(poses, weights, free, out.p);
    if (!p.allFinite()) break;
    out.p = p;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const NormTerm term = norm_term(p, poses[k]);
      size[k] = std::abs(term.residual) / std::sqrt(term.variance);
    }
    s = std_of_median * shrunk * *median(size);
    if (!(s > 0.0)) break;
    for (std::size_t k = 0; k < poses.size(); ++k)
      weights[k] = 1.0 / (1.0 + std::pow(size[k] / s / cauchy, 2));
  }
  for (std::size_t k = 0; k < poses.size(); ++k) out.kept[k] = !(s > 0.0 && size[k] > far * s);
  return out;
}

std::vector<bool> least_trimmed(View<NormalisedPose> poses,
                                NormParameters free,
                                const Parameters& start,
                                std::size_t keep) {
  constexpr int subsets = 60, steps_to_fit = 2, steps_to_concentrate = 4;
  std::mt19937_64 random(1);
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> weights(poses.size());
  std::vector<bool> best(poses.size(), true);
  double least = std::numeric_limits<double>::infinity();
  for (int subset = 0; subset < subsets; ++subset) {
    std::ranges::shuffle(order, random);
    std::ranges::fill(weights, 0.0);
    for (std::size_t k = 0; k < static_cast<std::size_t>(free); ++k) weights[order[k]] = 1.0;
    Parameters p = start;
    for (int step = 0; step < steps_to_fit; ++step) p = newton_step(poses, weights, free, p);
    double sum = 0.0;
    for (int step = 0; step < steps_to_concentrate && p.allFinite(); ++step) {
      sum = weigh_smallest(squares_of(poses, p), keep, weights);
      p = newton_step(poses, weights, free, p);
    }
    if (!p.allFinite()) continue;
    sum = weigh_smallest(squares_of(poses, p), keep, weights);
    if (!(sum < least)) continue;
    least = sum;
    for (std::size_t k = 0; k < poses.size(); ++k) best[k] = weights[k] != 0.0;
  }
  return best;
}

}  // namespace proofmass::calibrate
