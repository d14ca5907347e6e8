#pragma once

#include <Eigen/Core>

#include "proofmass/calibrate/rotation.hpp"
#include "proofmass/calibrate/rotation_pass.hpp"

// From the harmonics of a turning wheel's readings to the coefficients of the model equation.
namespace proofmass::calibrate {

/// Of a figure: standard deviation and the degrees of freedom that it has itself.
struct RotationSpread {
  double std = 0.0, dof = 0.0;
  bool widened = false;
};

/// The harmonics of all axes, one behind the other, and how they scatter from block to block.
struct RotationEstimate {
  Eigen::VectorXd harmonics;
  BlockScores blocks;
  std::size_t constraints = 1;  ///< that the scores of one harmonic obey: 2 with a term in ω²

  /// Of gradient · harmonics,
  ///
  ///     var = B/(B − 1) Σ_b z_b²,   z_b = gradient · score_b,
  ///
  /// at least (1 + ρ)/(1 − ρ) times that where the z of neighbouring blocks have a correlation ρ
  /// beyond chance (one-sided 5 %). A `slow` figure hangs on the mean of the readings, in which
  /// noise remembers longest: its blocks are joined, up to three to one, at least six being left.
  [[nodiscard]] RotationSpread spread_of(const Eigen::VectorXd& gradient, bool slow) const;
  [[nodiscard]] double dof() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;
};

/// Two axes without an encoder: finds ripples of speed once and twice a turn, and takes those that
/// are accepted out of the estimate. Where the radius is told, what the ripple makes of r ω² and
/// r ω̇ once a turn goes with it.
void separate_ripples(const RotationState& state, RotationEstimate& estimate, RotationFit& fit);

/// Fills in the coefficients of all axes, the radius, and the notes on what was widened.
void fill_rotation(const RotationState& state,
                   const RotationEstimate& estimate,
                   const RotationOptions& options,
                   RotationFit& fit);

/// The readings and residuals of each axis folded over the turns.
void fold_turns(const RotationState& state, RotationFit& fit);

}  // namespace proofmass::calibrate
