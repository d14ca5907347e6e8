#include "proofmass/calibrate/multi_position/pose_shifts.hpp"

#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {
namespace {

// Relative to a pose's own weight: with less left the others do not check it.
constexpr double least_redundancy = 1e-6;

// A square root of a positive inverse: root rootᵀ = A⁻¹.
Eigen::MatrixXd root_of_inverse(const Eigen::MatrixXd& A) {
  const SymmetricEigen eigen = symmetric_eigen(A);
  const double floor = 1e-14 * eigen.values.maxCoeff();
  return eigen.vectors * eigen.values.cwiseMax(floor).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

PoseShifts::PoseShifts(const NormData& data,
                       const std::vector<NormTerm>& terms,
                       NormParameters free) {
  const auto n = static_cast<Eigen::Index>(terms.size());
  W_ = residual_weights(data, terms, std::vector<bool>(terms.size(), true));
  Eigen::MatrixXd J(n, static_cast<Eigen::Index>(free));
  Eigen::VectorXd r(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const NormTerm& term = terms[static_cast<std::size_t>(k)];
    J.row(k) = term.gradient.head(J.cols());
    r(k) = term.residual;
  }
  const Eigen::MatrixXd WJ = W_.times(J);
  A_ = WJ * root_of_inverse(J.transpose() * WJ);
  g_ = W_.times(r).col(0) - A_ * (A_.transpose() * r);
  rss_ = std::max(0.0, r.dot(g_));
}

double PoseShifts::q(std::size_t i, std::size_t j) const {
  const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
  return W_(row, column) - A_.row(row).dot(A_.row(column));
}

std::optional<PoseShifts::Shift> PoseShifts::shift_of(std::size_t k) const {
  const double own = q(k, k), alone = W_.diagonal(static_cast<Eigen::Index>(k));
  if (!(own > least_redundancy * alone)) return std::nullopt;
  return Shift{g(k) / own, 1.0 / own};
}

std::vector<double> PoseShifts::gains(const PoseSet& out) const {
  const auto n = static_cast<Eigen::Index>(out.size());
  Eigen::MatrixXd Q(n, n);
  Eigen::VectorXd g(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = out[static_cast<std::size_t>(i)];
    g(i) = g_(static_cast<Eigen::Index>(k));
    for (Eigen::Index j = 0; j <= i; ++j)
      Q(i, j) = Q(j, i) = q(k, out[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd cofactor = positive_inverse(Q);
  const Eigen::VectorXd error = cofactor * g;
  std::vector<double> gains;
  for (Eigen::Index i = 0; i < n; ++i) gains.push_back(error(i) * error(i) / cofactor(i, i));
  return gains;
}

std::optional<double> PoseShifts::rss_without(const PoseSet& out) const {
  if (out.empty()) return rss_;
  const std::size_t k = out.front();
  const std::optional<Shift> one = shift_of(k);
  if (!one) return std::nullopt;
  if (out.size() == 1) return std::max(0.0, rss_ - one->value * g(k));
  if (out.size() > 2) return without({k}).rss_without({out.begin() + 1, out.end()});
  const std::size_t l = out.back();
  const double own = q(l, l) - q(k, l) * q(k, l) * one->cofactor;
  if (!(own > least_redundancy * W_.diagonal(static_cast<Eigen::Index>(l)))) return std::nullopt;
  const double left = g(l) - q(k, l) * one->value;
  return std::max(0.0, rss_ - one->value * g(k) - left * left / own);
}

// One more column of A: Q − Q_k Q_kᵀ / Q_kk.
PoseShifts PoseShifts::without(const PoseSet& out) const {
  PoseShifts next = *this;
  for (const std::size_t k : out) {
    const std::optional<Shift> one = next.shift_of(k);
    if (!one) continue;
    Eigen::VectorXd column(next.g_.size());
    for (std::size_t i = 0; i < next.poses(); ++i)
      column(static_cast<Eigen::Index>(i)) = next.q(i, k);
    next.rss_ = std::max(0.0, next.rss_ - one->value * next.g(k));
    next.g_ -= one->value * column;
    next.A_.conservativeResize(Eigen::NoChange, next.A_.cols() + 1);
    next.A_.rightCols<1>() = std::sqrt(one->cofactor) * column;
  }
  return next;
}

}  // namespace proofmass::calibrate
