#pragma once

#include <Eigen/Core>

#include "proofmass/calibrate/rotating/pass.hpp"
#include "proofmass/calibrate/rotation.hpp"

// Coefficients of the model equation from the harmonics of a rotating wheel.
namespace proofmass::calibrate {

/// Standard deviation of a result, and its own degrees of freedom.
struct RotationSpread {
  double std = 0.0, dof = 0.0;
  bool widened = false;
};

/// The harmonics of all axes, concatenated, and their scatter between blocks.
struct RotationEstimate {
  Eigen::VectorXd harmonics;
  BlockScores blocks;
  /// Errors not included in the scatter of the blocks: each changes the harmonics along its vector
  /// by at most ± 1 in 95 % of tests.
  std::vector<Eigen::VectorXd> bounds;
  /// Bounds that may be fully reached, so that they add linearly to the others.
  std::vector<Eigen::VectorXd> shared;

  /// Standard deviation of gradient · harmonics, by the blocks alone,
  ///
  ///     var = Σ_s B_s/(B_s − 1) Σ_b z_b²,   z_b = gradient · score_b, B_s blocks of section s,
  ///
  /// with Welch's degrees of freedom: radius, ripple and delay take a mean from every section. At
  /// least (1 + ρ)/(1 − ρ) times that if the z of neighbouring blocks have a significant
  /// correlation ρ (one-sided 5 %). A `slow` result depends on the mean output, whose noise has the
  /// longest correlation: its blocks are merged, up to three to one, with at least six left and
  /// four of each section.
  [[nodiscard]] RotationSpread spread_of(const Eigen::VectorXd& gradient, bool slow) const;
  /// Half width of a 95 % interval of gradient · harmonics, with `by_scatter` that of the scatter.
  [[nodiscard]] double half_width(const Eigen::VectorXd& gradient, double by_scatter) const;
  [[nodiscard]] double dof() const;
  [[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& scores) const;
};

/// Fills the coefficients of all axes, the radius, and the notes on widened intervals.
void fill_rotation(const RotationState& state,
                   const RotationEstimate& estimate,
                   const RotationOptions& options,
                   RotationFit& fit);

/// Outputs and residuals of each axis folded over the turns.
void fold_turns(const RotationState& state, RotationFit& fit);

}  // namespace proofmass::calibrate
