#pragma once

#include <Eigen/Core>

#include "proofmass/calibrate/rotation.hpp"
#include "proofmass/calibrate/rotation_pass.hpp"

// From the harmonics of a turning wheel's readings to the coefficients of the model equation.
namespace proofmass::calibrate {

/// Standard deviation of a figure, and its own degrees of freedom.
struct RotationSpread {
  double std = 0.0, dof = 0.0;
  bool widened = false;
};

/// The harmonics of all axes, one behind the other, and how they scatter from block to block.
struct RotationEstimate {
  Eigen::VectorXd harmonics;
  BlockScores blocks;
  /// Errors that the scatter of the blocks does not show: each moves the harmonics along its vector
  /// by no more than ± 1 in 95 % of tests.
  std::vector<Eigen::VectorXd> bounds;
  /// The same where the error may well be all of it, so that it adds to the others' in full.
  std::vector<Eigen::VectorXd> shared;

  /// Of gradient · harmonics, by the blocks alone,
  ///
  ///     var = Σ_s B_s/(B_s − 1) Σ_b z_b²,   z_b = gradient · score_b, B_s blocks of section s,
  ///
  /// with Welch's degrees of freedom: radius, ripple and delay take a mean from every section. At
  /// least (1 + ρ)/(1 − ρ) times that where the z of neighbouring blocks have a correlation ρ
  /// beyond chance (one-sided 5 %). A `slow` figure hangs on the mean of the readings, in which
  /// noise remembers longest: its blocks are joined, up to three to one, at least six being left
  /// and four of each section.
  [[nodiscard]] RotationSpread spread_of(const Eigen::VectorXd& gradient, bool slow) const;
  /// Half the width of a 95 % interval of gradient · harmonics, that of the scatter being
  /// `by_scatter`.
  [[nodiscard]] double half_width(const Eigen::VectorXd& gradient, double by_scatter) const;
  [[nodiscard]] double dof() const;
  [[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& scores) const;
};

/// Fills in the coefficients of all axes, the radius, and the notes on what was widened.
void fill_rotation(const RotationState& state,
                   const RotationEstimate& estimate,
                   const RotationOptions& options,
                   RotationFit& fit);

/// The readings and residuals of each axis folded over the turns.
void fold_turns(const RotationState& state, RotationFit& fit);

}  // namespace proofmass::calibrate
