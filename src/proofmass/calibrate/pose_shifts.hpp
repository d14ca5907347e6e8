#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/calibrate/norm_fit.hpp"

// What a fit says of every pose, and of errors that some of them may have.
namespace proofmass::calibrate {

/// Poses taken for bad, ascending.
using PoseSet = std::vector<std::size_t>;

/// Residuals of all poses, linear about a fit, with an unknown error in the length of some:
///
///     r = J dp + δ + noise,     Q = W − W J (Jᵀ W J)⁻¹ Jᵀ W.
///
/// A set S of errors lowers the least sum rᵀQr by gᵀ Q_SS⁻¹ g with g = (Q r)_S, the errors being
/// Q_SS⁻¹ g with the cofactors Q_SS⁻¹; to take one for unknown is to leave its pose out.
/// Source: W. Baarda, A testing procedure for use in geodetic networks (1968); R. D. Cook, S.
/// Weisberg, Residuals and Influence in Regression (1982), section 2.2.
class PoseShifts {
 public:
  /// `terms` of all poses at `p`, which need not be a least-squares fit of them.
  PoseShifts(const NormData& data, const std::vector<NormTerm>& terms, NormParameters free);

  /// The least sum of squares without these poses; absent where the others do not carry the
  /// parameters, or as good as not.
  [[nodiscard]] std::optional<double> rss_without(const PoseSet& out) const;

  /// The model with the lengths of these poses unknown. rss_without(out) must be there.
  [[nodiscard]] PoseShifts without(const PoseSet& out) const;

  /// Of the error of a pose, were it the only one: estimate and cofactor. Absent where the others
  /// do not show it.
  struct Shift {
    double value, cofactor;
  };
  [[nodiscard]] std::optional<Shift> shift_of(std::size_t k) const;

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
