#pragma once

#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// The six positions ±x, ±y, ±z up, assumed exact, with m(±k) the mean outputs and U column by
/// column m(+k) − m(−k):
///
///     bias_k = (m_k(+k) + m_k(−k)) / 2,     scale_k = |row k of U| / 2g.
///
/// Misalignment is not identifiable: it is not separable from the sensor's placement. A tilt of std
/// θ about either axis, with axes skewed by angles of std α, changes a bias by θ √(θ²/2 + α²) g and
/// a scale by √((θ² + α²)² + c² (θ²/2 + α²)) of it, to leading order, with c the part of row k
/// across its axis. Several poses of one position are averaged. Source: F. Ferraris, U. Grimaldi,
/// M. Parvis, Procedure for effortless in-field calibration of three-axial rate gyro and
/// accelerometers, Sensors and Materials 7 (1995) 311. Errors: invalid_argument (a direction is
/// missing, or is not an axis).
[[nodiscard]] Result<MultiPosition> calibrate_six_position(View<Pose> poses,
                                                           double noise_dof,
                                                           const MultiPositionOptions& options);

}  // namespace proofmass::calibrate
