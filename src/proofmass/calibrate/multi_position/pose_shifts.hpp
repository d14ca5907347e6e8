#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position/norm_fit.hpp"

// Residual analysis of every pose, with possible errors of some of them.
namespace proofmass::calibrate {

/// Bad poses, ascending.
using PoseSet = std::vector<std::size_t>;

/// Residuals of all poses, linearised about a fit, with an unknown error in the norm of some:
///
///     r = J dp + δ + noise,     Q = W − W J (Jᵀ W J)⁻¹ Jᵀ W.
///
/// A set S of errors lowers the least sum rᵀQr by gᵀ Q_SS⁻¹ g with g = (Q r)_S, the errors being
/// Q_SS⁻¹ g with the cofactors Q_SS⁻¹; an unknown error is equivalent to omitting its pose. Source:
/// W. Baarda, A testing procedure for use in geodetic networks (1968); R. D. Cook, S. Weisberg,
/// Residuals and Influence in Regression (1982), section 2.2.
class PoseShifts {
 public:
  /// `terms` of all poses at `p`, which need not be a least-squares fit of them.
  PoseShifts(const NormData& data, const std::vector<NormTerm>& terms, NormParameters free);

  /// The smallest sum of squares without these poses; absent if the others do not, or barely,
  /// determine the parameters.
  [[nodiscard]] std::optional<double> rss_without(const PoseSet& out) const;

  /// The model with unknown norms of these poses. Requires rss_without(out).
  [[nodiscard]] PoseShifts without(const PoseSet& out) const;

  /// Error of a pose, if it were the only one: estimate and cofactor. Absent if the others do not
  /// determine it.
  struct Shift {
    double value, cofactor;
  };
  [[nodiscard]] std::optional<Shift> shift_of(std::size_t k) const;

  /// By how much the error of each of these poses lowers the smallest sum of squares, beside the
  /// errors of the others of them: e_k² / (Q_SS⁻¹)_kk with e = Q_SS⁻¹ g.
  [[nodiscard]] std::vector<double> gains(const PoseSet& out) const;

  [[nodiscard]] std::size_t poses() const { return static_cast<std::size_t>(g_.size()); }

 private:
  PoseShifts() = default;
  [[nodiscard]] double q(std::size_t i, std::size_t j) const;
  [[nodiscard]] double g(std::size_t k) const { return g_(static_cast<Eigen::Index>(k)); }

  ResidualWeights W_;
  Eigen::MatrixXd A_;  // Q = W − A Aᵀ
  Eigen::VectorXd g_;  // Q r
  double rss_ = 0.0;
};

}  // namespace proofmass::calibrate
