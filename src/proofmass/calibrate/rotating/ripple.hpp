#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/rotating/results.hpp"

// Speed variation within the turn, without an encoder.
namespace proofmass::calibrate {

/// The harmonics 2 to 6 of one section, of one axis or of two, divided between a ripple of the
/// speed and the sensor.
///
/// A phase error ε moves E = S1 sin φ by S1 cos φ ε, so that its n-th harmonic moves the harmonics
/// n ± 1. On two orthogonal axes it moves the tangential part of the output, cos φ E₁ − sin φ E₂,
/// and not the radial part, sin φ E₁ + cos φ E₂. With q = C2/S1, p = S2/S1 and t = S3/S1 of each
/// axis, the radial part determines of the sensor's terms
///
///     q₁ − p₂,   p₁ + q₂,   t₁ + t₂,
///
/// while q₁ + p₂, p₁ − q₂ and t₁ − t₂ are equivalent to a ripple once a turn (cos, sin) and twice a
/// turn (sin). The split attributes these to the ripple; with one axis, all of its harmonics. Where
/// the radius is determined, a ripple moves −r ω² and r ω̇ too, the n-th by n and n² times r ω²/g.
struct RippleSplit {
  Eigen::VectorXd harmonics;    ///< of the section: the common ones and what its residuals add
  Eigen::MatrixXd ripple_rows;  ///< the ripple, by these; least squares
  Eigen::MatrixXd sensor_rows;  ///< q₁ − p₂, p₁ + q₂, t₁ + t₂; of one axis none
  Eigen::MatrixXd by_gradient;  ///< the ripple, by the gradient of the section's readings
  Eigen::MatrixXd effect;       ///< of the ripple on that gradient, with its sign turned
};

/// For each section, at the current state of the fit.
[[nodiscard]] std::vector<RippleSplit> split_ripples(const RotationState& state);

/// What a distance of 1 m from the axle along the first axis, and along the second, adds to the
/// harmonics by −r ω² and r ω̇ of a ripple: two columns.
[[nodiscard]] Eigen::MatrixXd ripple_by_radius(const RotationState& state,
                                               const Ripple& ripple,
                                               double gravity_mps2);

/// With an encoder: each section's ripple, from the angle itself.
void measure_ripples(RotationState& state);

/// With an encoder, at one speed: bounds of the ripple's effect through r ω² and r ω̇.
void allow_for_radius(const RotationState& state,
                      const RotationOptions& options,
                      RotationEstimate& estimate);

/// Fits each section's ripple: the phase absorbs it until the harmonics contain no more of it.
/// Returns whether that converged.
[[nodiscard]] bool fit_ripples(RotationState& state);

/// Divides the harmonics between ripple and sensor, see RippleSplit.
///
/// - An ambiguous part is left with the sensor, with a bound of its whole size, the rms over the
///   sections.
/// - If it is significant and the sensor's determined terms of that order are far smaller, it is
///   attributed to the ripple, with the bound of Student's t from those terms.
/// - The noise that each section's ripple adds to the common harmonics is then in the blocks'
///   scores.
void separate_ripples(const RotationState& state,
                      const RotationSolver& solver,
                      const RotationOptions& options,
                      RotationEstimate& estimate,
                      RotationFit& fit);

}  // namespace proofmass::calibrate
