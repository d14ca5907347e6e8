#include "proofmass/calibrate/tumble/scatter.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

// V for one σ², with the terms of the likelihood.
class Covariance {
 public:
  Covariance(double variance, const std::vector<Eigen::VectorXd>& common)
      : variance_(variance), common_(common) {}

  // V⁻¹ X, by the Sherman–Morrison formula for each w.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& X) const {
    Eigen::MatrixXd out = X;
    for (const Eigen::VectorXd& w : common_) {
      const Eigen::RowVectorXd along = w.transpose() * X;
      out -= w * along / (variance_ + w.squaredNorm());
    }
    return out / variance_;
  }
  // tr V⁻¹ and tr V⁻²
  [[nodiscard]] double trace(int power, Eigen::Index n) const {
    const auto own = std::pow(variance_, -power);
    double sum = static_cast<double>(n) * own;
    for (const Eigen::VectorXd& w : common_)
      if (w.squaredNorm() > 0.0) sum += std::pow(variance_ + w.squaredNorm(), -power) - own;
    return sum;
  }

 private:
  double variance_;
  const std::vector<Eigen::VectorXd>& common_;
};

struct Likelihood {
  double score = 0.0;    // |P y|² − tr P
  double trace_2 = 0.0;  // tr P²
};

Likelihood likelihood(const Eigen::MatrixXd& A, const Eigen::VectorXd& y, const Covariance& V) {
  const Eigen::MatrixXd B = V.solve(A);
  const Eigen::MatrixXd inverse = positive_inverse(A.transpose() * B);
  const Eigen::MatrixXd lost = inverse * (B.transpose() * B);
  const Eigen::VectorXd P_y = V.solve(y) - B * (inverse * (B.transpose() * y));
  return {.score = P_y.squaredNorm() - (V.trace(1, A.rows()) - lost.trace()),
          .trace_2 = V.trace(2, A.rows()) - 2.0 * (inverse * (B.transpose() * V.solve(B))).trace() +
                     (lost * lost).trace()};
}

}  // namespace

TumbleScatter restricted_scatter(const Eigen::MatrixXd& A,
                                 const Eigen::VectorXd& y,
                                 const std::vector<Eigen::VectorXd>& common) {
  const Eigen::VectorXd r = y - A * (positive_inverse(A.transpose() * A) * (A.transpose() * y));
  const auto dof = static_cast<double>(A.rows() - A.cols());
  const double most = r.squaredNorm() / dof;
  if (most <= 0.0) return {0.0, dof};
  double low = 1e-8 * most, high = 2.0 * most;
  if (likelihood(A, y, Covariance(low, common)).score <= 0.0) return {std::sqrt(most), dof};
  constexpr int steps = 60;
  for (int k = 0; k < steps && high > low * (1.0 + 1e-9); ++k) {
    const double middle = std::sqrt(low * high);
    (likelihood(A, y, Covariance(middle, common)).score > 0.0 ? low : high) = middle;
  }
  const double variance = std::sqrt(low * high);
  const double trace_2 = likelihood(A, y, Covariance(variance, common)).trace_2;
  return {std::sqrt(variance), std::clamp(variance * variance * trace_2, 1.0, dof)};
}

}  // namespace proofmass::calibrate
