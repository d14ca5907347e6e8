#pragma once

#include <Eigen/Core>

#include "proofmass/calibrate/rotation_results.hpp"

// A speed that varies within the turn, where no encoder gives the angle.
namespace proofmass::calibrate {

/// The harmonics 2 to 6 of one axis, or of two, divided between a ripple of the speed and the
/// sensor, relative to S1.
///
/// A phase error ε moves E = S1 sin φ by S1 cos φ ε, so that its n-th harmonic moves the harmonics
/// n ± 1. On two axes square to each other it moves the tangential part of the readings, cos φ E₁ −
/// sin φ E₂, and not the radial part, sin φ E₁ + cos φ E₂. Of the sensor's terms, with
/// q = C2/S1, p = S2/S1 and t = S3/S1 of each axis, the radial part determines
///
///     q₁ − p₂,   p₁ + q₂,   t₁ + t₂,
///
/// while q₁ + p₂, p₁ − q₂ and t₁ − t₂ look like a ripple once a turn (cos, sin) and twice a turn
/// (sin). The split puts these down to the ripple; of one axis, all of its harmonics.
class RippleSplit {
 public:
  explicit RippleSplit(std::size_t axes);

  /// The ripple in these harmonics, least squares.
  [[nodiscard]] Ripple ripple(const Eigen::VectorXd& harmonics) const;
  /// q₁ − p₂, p₁ + q₂, t₁ + t₂; zero of one axis.
  [[nodiscard]] Eigen::Vector3d sensor(const Eigen::VectorXd& harmonics) const;
  /// Their derivatives by the harmonics; both as rows.
  [[nodiscard]] Eigen::MatrixXd ripple_rows(const Eigen::VectorXd& harmonics) const;
  [[nodiscard]] Eigen::MatrixXd sensor_rows(const Eigen::VectorXd& harmonics) const;
  /// What each part of a ripple adds to the harmonics, first order, with the first axis's C1 kept
  /// at zero by its phase: one column each.
  [[nodiscard]] Eigen::MatrixXd moved(const Eigen::VectorXd& harmonics) const;

 private:
  [[nodiscard]] Eigen::VectorXd scale(const Eigen::VectorXd& harmonics) const;

  std::size_t axes_;
  Eigen::MatrixXd moved_;  ///< relative to S1
  Eigen::MatrixXd rows_;   ///< (ripple, sensor) × harmonics relative to S1
};

/// What a distance of 1 m from the axle along the first axis, and along the second, adds to the
/// harmonics by −r ω² and r ω̇ of a ripple: two columns.
[[nodiscard]] Eigen::MatrixXd ripple_by_radius(const RotationState& state,
                                               const Ripple& ripple,
                                               double gravity_mps2);

/// With an encoder: each section's ripple, by the angle itself.
void measure_ripples(RotationState& state);

/// With an encoder, at one speed: the bounds of what its ripple makes of r ω² and r ω̇.
void allow_for_radius(const RotationState& state,
                      const RotationOptions& options,
                      RotationEstimate& estimate);

/// Fits each section's ripple: the phase takes it up until the harmonics hold no more of it.
void fit_ripples(RotationState& state);

/// Divides the harmonics between ripple and sensor, see RippleSplit. A part that could be either is
/// left with the sensor, with a bound of its whole size; where it is beyond chance and the sensor's
/// determined terms of that order are far smaller, it is put down to the ripple, with the bound
/// that Student's t gives from those terms.
void separate_ripples(const RotationState& state,
                      const RotationOptions& options,
                      RotationEstimate& estimate,
                      RotationFit& fit);

}  // namespace proofmass::calibrate
